-- Neovim takes the parser and the queries, and colours by them.

local function finish(ok, words)
  io.stdout:write(words .. '\n')
  vim.cmd(ok and 'qall!' or 'cquit!')
end

local ok, fault = pcall(vim.treesitter.get_parser, 0, 'mech')
if not ok then
  -- made for a newer editor
  finish(fault:find('ABI') ~= nil, 'neovim: no tree: ' .. fault)
  return
end
ok, fault = pcall(function()
  local root = vim.treesitter.get_parser(0, 'mech'):parse()[1]:root()
  assert(not root:has_error(), 'the text is right')
  local get = vim.treesitter.query and vim.treesitter.query.get or vim.treesitter.query.get_query
  local text_of = vim.treesitter.get_node_text or vim.treesitter.query.get_node_text
  for _, name in ipairs({ 'highlights', 'folds', 'indents', 'injections', 'locals', 'textobjects' }) do
    local query, found = get('mech', name), 0
    for _ in query:iter_captures(root, 0) do
      found = found + 1
    end
    assert(found > 0, name .. ' finds nothing')
  end
  local query, colours = get('mech', 'highlights'), {}
  for id, node in query:iter_captures(root, 0) do
    colours[text_of(node, 0) .. ' ' .. query.captures[id]] = true
  end
  for _, wanted in ipairs({ 'mm type.builtin', 'revolute function.builtin', 'y function.builtin', 'body keyword', 'four_bar type',
    'coupler type', 'C property', '60 number', 'in keyword' }) do
    assert(colours[wanted], wanted .. ' is missing')
  end
  assert(vim.treesitter.highlighter.active[vim.api.nvim_get_current_buf()], 'the text is not coloured')
end)
finish(ok, ok and 'neovim: tree and queries' or 'neovim: ' .. fault)
