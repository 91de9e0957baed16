-- How a .mech file is edited; starts the language server.
vim.bo.commentstring = '// %s'
vim.bo.expandtab, vim.bo.shiftwidth, vim.bo.softtabstop, vim.bo.smartindent = true, 4, 4, true

-- colours, once parser/mech.so is there; vim/ has some without
if #vim.api.nvim_get_runtime_file('parser/mech.so', false) > 0 then
  local _, treesitter = pcall(require, 'vim.treesitter.highlighter')
  if vim.treesitter.start then
    pcall(vim.treesitter.start)
  else
    pcall(function() treesitter.new(vim.treesitter.get_parser(0, 'mech')) end)
  end
end

if vim.fn.executable('mechc') == 1 then
  local folder = vim.fn.expand('%:p:h')
  local repository = vim.fn.finddir('.git', folder .. ';')
  local root = repository ~= '' and vim.fn.fnamemodify(repository, ':p:h:h') or folder
  local function show_lenses(_, buffer)
    if vim.lsp.codelens.enable then
      return vim.lsp.codelens.enable(true, { bufnr = buffer })
    end
    -- before 0.12
    local refresh = { buffer = buffer, callback = function() vim.lsp.codelens.refresh() end }
    refresh.group = vim.api.nvim_create_augroup('mechc_lenses_' .. buffer, {})
    vim.api.nvim_create_autocmd({ 'BufEnter', 'CursorHold', 'InsertLeave' }, refresh)
    vim.lsp.codelens.refresh()
  end
  local server = {
    name = 'mechc',
    cmd = { 'mechc', 'lsp' },
    root_dir = root,
    -- the server offers lenses for what plugin/mech.lua can do
    init_options = { commands = { 'mechc.view', 'mechc.run', 'mechc.check' } },
    on_attach = show_lenses,
  }
  if vim.lsp.start then
    vim.lsp.start(server)
  else -- before 0.8
    _G.mechc_client = _G.mechc_client or vim.lsp.start_client(server)
    vim.lsp.buf_attach_client(0, _G.mechc_client)
  end
end
