" Colours of .mech files.
if exists('b:current_syntax')
  finish
endif

" names behind a dot are no words of the language
syntax match mechMember /\.\s*\k\+/
syntax match mechNumber /\v<\d+%(\.\d+)?%([eE][-+]?\d+)?|\.\d+%([eE][-+]?\d+)?/
syntax match mechUnit /\v\d@1<=[[:alpha:]µ]+/
syntax match mechOperator /[-+*^<>=!]\|\.\.=\?\|\//
syntax match mechComment /\/\/.*/ contains=mechTodo,@Spell
syntax match mechDocumentation /\/\/\/.*/ contains=mechTodo,@Spell
syntax keyword mechTodo TODO FIXME contained
syntax region mechString start=/"/ end=/"\|$/ oneline
syntax region mechBlock start=/{/ end=/}/ transparent fold

" <words declarations>
syntax keyword mechDeclaration mechanism param fn table ground body point axis circle curve joint driver
syntax keyword mechDeclaration constraint measure analysis
" </words>

" <words formula>
syntax keyword mechFormula if then else and or not
" </words>

" <words called>
syntax match mechFunction /\v<%(abs|acos|angle|argmax|argmin|asin|at|atan|atan2|cos|cosh|curvature|cycloidal|der|direction|displacement|distance|effort|exp|first|force_x|force_y|harmonic|hypot|integral|last|length|ln|log10|max|mean|mid|min|mod|modsine|polar|pole_x|pole_y|poly|pressure_angle|rms|rotation|sign|sin|sinh|slip|speed|sqrt|step|step5|step7|tan|tanh|torque|x|y)>\ze\s*\(/
" </words>

" <words joints>
syntax match mechJoint /\v<%(revolute|translational|weld|revolute_revolute|revolute_translational|gear|internal_gear|belt|rack_pinion|point_follower|cam|flat_follower)>\ze\s*\(/
" </words>

" <words constants>
syntax keyword mechConstant t pi tau
" </words>

" <words units>
syntax keyword mechUnit m mm cm um µm km ft rad mrad deg rev s ms us µs Hz rpm kg lbm N kN lbf J W kW Pa kPa
syntax keyword mechUnit MPa bar
" </words>

" the inch, unless another unit follows, in which something is printed
syntax match mechUnit /\v%([0-9.]\s*)@8<=in>/
" names too, which are none of these words where they are declared, called or set
" <words contextual>
syntax match mechPlace /\v<%(use|load|trace|result|input|part|mass|gravity|require|to|every|within|along|at|toward|radius|inertia|from|on|spline|in|mirrored|as|columns|periodic)>\ze\s+[^-+*\/^=<>: \t]/
syntax match mechPlace /\v[^=,(]\s\zsmirrored>\ze\s*$/
syntax match mechConstant /\v,\s*\zs%(left|right|crossed)>\ze\s*\)/
" </words>

highlight default link mechNumber Number
highlight default link mechUnit Type
highlight default link mechOperator Operator
highlight default link mechComment Comment
highlight default link mechDocumentation SpecialComment
highlight default link mechTodo Todo
highlight default link mechString String
highlight default link mechDeclaration Keyword
highlight default link mechFormula Conditional
highlight default link mechPlace Statement
highlight default link mechFunction Function
highlight default link mechJoint Special
highlight default link mechConstant Constant

let b:current_syntax = 'mech'
