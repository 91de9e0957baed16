" How a .mech file is edited.
if exists('b:did_ftplugin')
  finish
endif
let b:did_ftplugin = 1

setlocal commentstring=//\ %s comments=:///,:// formatoptions-=t formatoptions+=croql
setlocal expandtab shiftwidth=4 softtabstop=4 cindent cinoptions=J1,(s,m1,+2s cinwords=
let b:undo_ftplugin = 'setlocal commentstring< comments< formatoptions< expandtab< shiftwidth< softtabstop< cindent< cinoptions< cinwords<'
if executable('mechc')
  setlocal formatexpr=mech#Format()
  let b:undo_ftplugin .= ' formatexpr<'
endif
