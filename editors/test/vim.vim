" Every word of the language has its colour in Vim, and a word that is a name has none; `gq` formats the whole text or nothing.
" vim -u NONE -N -es --cmd 'set runtimepath^=editors/vim' -S editors/test/vim.vim

set encoding=utf-8
syntax enable
filetype plugin on
let s:faults = []

function s:Text(text)
  enew!
  call setline(1, split(a:text, "\n"))
  setfiletype mech
endfunction

" The groups that a word has, wherever it stands.
function s:Groups(word)
  call cursor(1, 1)
  let groups = []
  let flags = 'cW'
  while search('\V\(\k\)\@1<!' . a:word . '\(\k\)\@!', flags) > 0
    call add(groups, synIDattr(synID(line('.'), col('.'), 1), 'name'))
    let flags = 'W'
  endwhile
  return groups
endfunction

let s:wanted = {'Keyword': ['mechDeclaration', 'mechFormula', 'mechPlace', 'mechConstant', 'mechUnit'], 'Function': ['mechFunction'],
  \ 'Motion': ['mechFunction'], 'Quantity': ['mechFunction'], 'Reduction': ['mechFunction'], 'Joint': ['mechJoint'],
  \ 'Unit': ['mechUnit'], 'Constant': ['mechConstant', 'mechDeclaration']}
for s:word in json_decode(join(readfile($WORDS), ''))
  call s:Text(index(['use', 'as', 'columns'], s:word.name) >= 0
    \ ? "use \"a.mech\" as b\nmechanism c { table d = spline \"e.csv\" columns 1, 2 (s, mm) }" : s:word.example)
  let s:found = s:Groups(s:word.name)
  if empty(filter(copy(s:found), {_, group -> index(s:wanted[s:word.category], group) >= 0}))
    call add(s:faults, s:word.name . ' has no colour: ' . string(s:found))
  endif
endfor

call s:Text("mechanism a {\nparam at = to + 3mm // param\nbody b at (0, 0, 0) { point mm = (1, 2 mm) }\nmeasure e = x(b.mm) in mm\n}")
for [s:word, s:groups] in [['at', ['', 'mechPlace']], ['to', ['']], ['param', ['mechDeclaration', 'mechComment']],
  \ ['in', ['mechPlace']], ['x', ['mechFunction']]]
  if s:Groups(s:word) != s:groups
    call add(s:faults, s:word . ': ' . string(s:Groups(s:word)))
  endif
endfor
if s:Groups('mm')[-2:] != ['mechMember', 'mechUnit']
  call add(s:faults, 'mm: ' . string(s:Groups('mm')))
endif

call s:Text("mechanism a {\nbody b {\npoint P = (0, 0)\n}\n}")
normal! gg=G
if getline(1, '$') != ['mechanism a {', '    body b {', '        point P = (0, 0)', '    }', '}']
  call add(s:faults, 'indented as ' . string(getline(1, '$')))
endif

" what `gq` makes of a text, wherever in it
function s:Formatted(text)
  call s:Text(a:text)
  call cursor(2, 1)
  normal! gqq
  return getline(1, '$')
endfunction

for [s:text, s:wanted] in [
  \ ["mechanism a {\nparam b=3 mm\n\n\n\nparam c   = 4 mm\n}", ['mechanism a {', '    param b = 3 mm', '', '    param c = 4 mm', '}']],
  \ ["mechanism a {\nparam b=\n}", ['mechanism a {', 'param b=', '}']]]
  if s:Formatted(s:text) != s:wanted
    call add(s:faults, 'formatted as ' . string(getline(1, '$')))
  endif
endfor

call writefile(empty(s:faults) ? ['vim: all words'] : map(s:faults, '"vim: " . v:val'), $REPORT)
execute empty(s:faults) ? 'qall!' : 'cquit!'
