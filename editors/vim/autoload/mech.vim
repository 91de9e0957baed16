" `gq`: mechc takes whole files, so the whole text is formatted, or stays as it is with mechc's word why. While typing Vim breaks the
" lines of comments itself.
function mech#Format()
  if mode() =~# '[iR]'
    return 1
  endif
  let made = systemlist('mechc fmt -', getline(1, '$'))
  if v:shell_error
    echohl ErrorMsg | echomsg get(filter(made, 'v:val =~# "\\S"'), 0, 'mechc fmt says nothing') | echohl None
    return 0
  endif
  let view = winsaveview()
  call setline(1, made)
  silent! call deletebufline('%', len(made) + 1, '$')
  call winrestview(view)
endfunction
