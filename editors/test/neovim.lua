-- What a user does in Neovim: sees a mistake, mends it, completes a point, renames a body in two files, formats, looks at a
-- hover, runs a lens, and opens the page of the text.
-- nvim --headless --clean --cmd 'set runtimepath^=editors/neovim' -c 'luafile editors/test/neovim.lua' FOLDER/four_bar.mech

local PATIENCE = 20000

local function finish(code, words)
  io.stdout:write(words .. '\n')
  vim.cmd(code == 0 and 'qall!' or 'cquit!')
end

local function wait(what, condition)
  if not vim.wait(PATIENCE, condition, 20) then
    error('waited in vain for ' .. what)
  end
end

local function client()
  local found = (vim.lsp.get_clients or vim.lsp.get_active_clients)()
  return found[1]
end

local function ask(method, params)
  local answers, fault = vim.lsp.buf_request_sync(0, method, params, PATIENCE)
  for _, answer in pairs(answers or {}) do
    if answer.err then
      error(method .. ': ' .. vim.inspect(answer.err))
    end
    return answer.result
  end
  error(method .. ': ' .. tostring(fault))
end

local function messages()
  return vim.tbl_map(function(one) return one.message end, vim.diagnostic.get(0))
end

local function says(words)
  return function()
    return #vim.tbl_filter(function(message) return message:find(words, 1, true) end, messages()) > 0
  end
end

-- The cursor goes behind some words.
local function behind(words)
  vim.fn.cursor(1, 1)
  assert(vim.fn.search('\\V' .. words, 'ceW') > 0, 'no ' .. words)
end

local function position()
  return vim.lsp.util.make_position_params(0, client().offset_encoding)
end

local steps = {}

function steps.diagnostic()
  wait('the diagnostics', says('no kind of joint `revolut`'))
  assert(says('expected a name')(), vim.inspect(messages()))
end

function steps.fix()
  behind('revolut(')
  local params = vim.lsp.util.make_range_params(0, client().offset_encoding)
  params.context = { diagnostics = vim.lsp.diagnostic.get_line_diagnostics and vim.lsp.diagnostic.get_line_diagnostics() or {} }
  local chosen
  for _, action in ipairs(ask('textDocument/codeAction', params) or {}) do
    chosen = chosen or (action.title:find('revolute', 1, true) and action)
  end
  assert(chosen, 'no fix was offered')
  if not chosen.edit then
    chosen = ask('codeAction/resolve', chosen)
  end
  vim.lsp.util.apply_workspace_edit(chosen.edit, client().offset_encoding)
  wait('the mistake to go', function() return not says('no kind of joint')() end)
end

function steps.complete()
  behind('y(coupler.')
  local params = position()
  params.position.character = params.position.character + 1
  local result = ask('textDocument/completion', params)
  local items = result.items or result
  local labels = vim.tbl_map(function(item) return item.label end, items)
  assert(vim.tbl_contains(labels, 'B') and vim.tbl_contains(labels, 'C'), vim.inspect(labels))
  assert(not vim.tbl_contains(labels, 'pin'), vim.inspect(labels))
  for _, item in ipairs(items) do
    if item.label == 'C' then
      local line, column = vim.fn.line('.') - 1, vim.fn.col('.')
      if item.textEdit then
        local edit = item.textEdit
        vim.lsp.util.apply_text_edits({ { range = edit.range or edit.insert, newText = edit.newText } }, 0, client().offset_encoding)
      else
        vim.api.nvim_buf_set_text(0, line, column, line, column, { item.insertText or item.label })
      end
    end
  end
  wait('no diagnostics', function() return #messages() == 0 end)
end

function steps.rename()
  behind('drive.crank')
  vim.lsp.buf.rename('lever')
  wait('the rename', function() return vim.fn.search('drive\\.lever', 'nw') > 0 end)
end

function steps.format()
  if vim.lsp.buf.format then
    vim.lsp.buf.format({ timeout_ms = PATIENCE })
  else
    vim.lsp.buf.formatting_sync(nil, PATIENCE)
  end
end

function steps.hover()
  behind('y(coupler.C')
  local result = ask('textDocument/hover', position())
  assert(vim.inspect(result):find('C', 1, true), 'nothing is told of the point')
end

-- The lens `check` saves what was edited, and runs in a terminal.
function steps.lens()
  local place = { textDocument = vim.lsp.util.make_text_document_params() }
  local offered = {}
  for _, lens in ipairs(ask('textDocument/codeLens', place) or {}) do
    offered[lens.command.command] = lens.command
  end
  assert(offered['mechc.run'] and offered['mechc.check'], vim.inspect(offered))
  vim.cmd('doautocmd CursorHold')
  wait('the lenses', function() return #vim.lsp.codelens.get(0) >= 2 end)
  local edited = vim.api.nvim_get_current_buf()
  assert(vim.bo.modified, 'nothing is to be saved')
  vim.lsp.commands['mechc.check'](offered['mechc.check'])
  assert(not vim.bo[edited].modified, 'it runs what is not saved')
  wait('what it says', function()
    return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n'):find('four_bar', 1, true)
  end)
  vim.cmd('bwipeout!')
end

-- The page of the text, by the file that leads the browser there.
function steps.view()
  local opened
  vim.ui.open = function(path) opened = path end
  wait('the server', client)
  vim.cmd('MechView')
  wait('the page', function() return opened end)
  local leads = table.concat(vim.fn.readfile(opened))
  local origin, token = leads:match('url=(http://127%.0%.0%.1:%d+)/#(%x+)')
  assert(origin, leads)
  vim.cmd('doautocmd CursorMoved')
  -- a click in the page leads to its declaration
  vim.api.nvim_win_set_cursor(0, { 1, 0 })
  local text = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n')
  local at = text:find('body', 1, true) - 1
  local line = select(2, text:sub(1, at):gsub('\n', '')) + 1
  vim.fn.system({ 'curl', '-s', '-H', 'Origin: ' .. origin, '-H', 'X-Mechc-Token: ' .. token, '-d', ('{"at":%d}'):format(at), origin .. '/show' })
  wait('the place that was clicked', function() return vim.api.nvim_win_get_cursor(0)[1] == line end)
  -- where no server is there is no page, and nothing that tells one of the cursor
  vim.cmd('new')
  local told
  local notify = vim.notify
  vim.notify = function(words) told = words end
  vim.cmd('MechView')
  vim.notify = notify
  assert(told and told:find('no server', 1, true), tostring(told))
  assert(vim.fn.exists('#mechc_view_' .. vim.api.nvim_get_current_buf()) == 0, 'the cursor is told')
  vim.cmd('bwipeout!')
end

function steps.save()
  vim.cmd('wall')
end

local wanted = vim.env.STEPS or 'diagnostic fix complete rename format hover lens view save'
local begun = vim.loop.hrtime()
local ok, fault = pcall(function()
  for step in wanted:gmatch('%S+') do
    local ok, fault = pcall(steps[step])
    if not ok then
      error(step .. ': ' .. tostring(fault), 0)
    end
    io.stdout:write(('%s after %d ms\n'):format(step, (vim.loop.hrtime() - begun) / 1e6))
  end
end)
finish(ok and 0 or 1, ok and 'neovim: all steps' or 'neovim: ' .. fault)
