vim.api.nvim_create_autocmd({ 'BufRead', 'BufNewFile' }, { pattern = '*.mech', command = 'setfiletype mech' })
