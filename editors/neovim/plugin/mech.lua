-- Whether the server has the text of a buffer.
local function serves(buffer)
  local clients = vim.lsp.get_clients and vim.lsp.get_clients({ bufnr = buffer }) or vim.lsp.buf_get_clients(buffer)
  for _, client in pairs(clients) do
    if client.name == 'mechc' then return true end
  end
  return false
end

-- Where a page is clicked, before 0.8: a window that shows the text goes to the place; where none does, this one shows it.
if not vim.lsp.handlers['window/showDocument'] then
  vim.lsp.handlers['window/showDocument'] = function(_, asked, context)
    if asked.external then return { success = false } end
    local buffer = vim.uri_to_bufnr(asked.uri)
    local window = vim.fn.bufwinid(buffer)
    if window == -1 then
      window = vim.api.nvim_get_current_win()
      vim.api.nvim_win_set_buf(window, buffer)
    end
    if asked.takeFocus then vim.api.nvim_set_current_win(window) end
    if asked.selection then
      local client = vim.lsp.get_client_by_id(context.client_id)
      local place = asked.selection.start
      local line = vim.api.nvim_buf_get_lines(buffer, place.line, place.line + 1, false)[1] or ''
      local in_bytes = (client and client.offset_encoding) == 'utf-8'
      local column = in_bytes and place.character or vim.str_byteindex(line, math.min(place.character, (select(2, vim.str_utfindex(line)))), true)
      vim.api.nvim_win_set_cursor(window, { math.min(place.line + 1, vim.api.nvim_buf_line_count(buffer)), math.min(column, #line) })
    end
    return { success = true }
  end
end

-- The page of a text, in the browser: it follows what is typed, and lights what is declared at the cursor. The address holds a key, and
-- arguments of programs are for all users of a machine to see: so the browser is given a file that leads there.
local function view(buffer, mechanism)
  if not serves(buffer) then
    return vim.notify('mechc: no server has this text; `mechc` must be on the path, and the file be a .mech file', vim.log.levels.ERROR)
  end
  local document = { uri = vim.uri_from_bufnr(buffer) }
  vim.lsp.buf_request(buffer, 'mechc/view', { textDocument = document, mechanism = mechanism }, function(fault, answer)
    if fault or not answer then
      return vim.notify('mechc: ' .. (fault and fault.message or 'no page'), vim.log.levels.ERROR)
    end
    local file = vim.fn.tempname() .. '.html'
    vim.fn.writefile({ '<!doctype html><meta http-equiv="refresh" content="0; url=' .. answer.url .. '">' }, file)
    local named = vim.g.mechc_browser
    local open = named and function(path) vim.fn[named](path) end or vim.ui.open
      or function(path) vim.fn.jobstart({ vim.fn.has('mac') == 1 and 'open' or 'xdg-open', path }, { detach = true }) end
    open(file)
  end)
  local group = vim.api.nvim_create_augroup('mechc_view_' .. buffer, {})
  local function tell()
    for _, client in pairs((vim.lsp.get_clients or vim.lsp.get_active_clients)()) do
      if client.name == 'mechc' then
        local place = vim.lsp.util.make_position_params(0, client.offset_encoding)
        client.notify('mechc/cursor', { textDocument = document, position = place.position })
      end
    end
  end
  vim.api.nvim_create_autocmd({ 'CursorMoved', 'CursorMovedI' }, { buffer = buffer, group = group, callback = tell })
end

vim.api.nvim_create_user_command('MechView', function(given)
  view(vim.api.nvim_get_current_buf(), given.args ~= '' and given.args or nil)
end, { nargs = '?' })

vim.lsp.commands['mechc.view'] = function(command)
  local uri, mechanism = unpack(command.arguments)
  view(vim.uri_to_bufnr(uri), mechanism)
end

-- The commands of the code lenses above a mechanism. mechc reads files, so what was edited is saved first.
for _, word in ipairs({ 'run', 'check' }) do
  vim.lsp.commands['mechc.' .. word] = function(command)
    local uri, mechanism = unpack(command.arguments)
    vim.api.nvim_buf_call(vim.uri_to_bufnr(uri), function() vim.cmd('silent update') end)
    vim.cmd('botright new')
    vim.fn.termopen({ 'mechc', word, '--mechanism', mechanism, '--', vim.uri_to_fname(uri) })
  end
end
