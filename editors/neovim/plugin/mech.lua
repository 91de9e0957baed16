-- The commands of the code lenses above a mechanism.
for _, word in ipairs({ 'run', 'check' }) do
  vim.lsp.commands['mechc.' .. word] = function(command)
    local uri, mechanism = unpack(command.arguments)
    vim.cmd('botright new')
    vim.fn.termopen({ 'mechc', word, '--mechanism', mechanism, '--', vim.uri_to_fname(uri) })
  end
end
