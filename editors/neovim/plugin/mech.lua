-- The commands of the code lenses above a mechanism. mechc reads files, so what was edited is saved first.
for _, word in ipairs({ 'run', 'check' }) do
  vim.lsp.commands['mechc.' .. word] = function(command)
    local uri, mechanism = unpack(command.arguments)
    vim.api.nvim_buf_call(vim.uri_to_bufnr(uri), function() vim.cmd('silent update') end)
    vim.cmd('botright new')
    vim.fn.termopen({ 'mechc', word, '--mechanism', mechanism, '--', vim.uri_to_fname(uri) })
  end
end
