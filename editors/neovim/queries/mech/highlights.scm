; Captures have the names that Neovim and tree-sitter's own command use. A later pattern stands over an earlier one.

(comment) @comment
(doc_comment) @comment.documentation
(string) @string
(table_file path: (string) @string.special.path)
(use path: (string) @string.special.path)
[(number) (exponent)] @number
(unit_product "1" @number)
(unit) @type.builtin

[
  "use" "as" "mechanism" "param" "fn" "table" "input" "part" "ground" "body" "point" "axis" "circle" "curve" "joint" "driver"
  "constraint" "mass" "gravity" "load" "measure" "trace" "result" "require" "analysis" "periodic" "spline" "columns" "on" "at" "toward"
  "mirrored" "along" "to" "radius" "inertia" "from" "every" "in" "within"
] @keyword
["if" "then" "else"] @keyword.conditional
["and" "or" "not"] @keyword.operator

["+" "-" "*" "/" "^" "<" "<=" ">" ">=" "==" "!=" "=" ".." "..="] @operator
["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["," ":" "."] @punctuation.delimiter

; ---- names where they are declared

(mechanism name: (identifier) @type)
(mechanism_name name: (identifier) @type)
(mechanism_name prefix: (identifier) @module)
(use prefix: (identifier) @module)
[
  (param name: (identifier) @constant)
  (input name: (identifier) @variable)
  (part name: (identifier) @variable)
  (body name: (identifier) @type)
  (joint name: (identifier) @variable)
  (driver name: (identifier) @variable)
  (constraint name: (identifier) @variable)
  (measure name: (identifier) @variable)
  (load name: (identifier) @variable)
  (trace name: (identifier) @variable)
  (result name: (identifier) @variable)
  (require name: (identifier) @variable)
]
(point name: (identifier) @property)
(axis name: (identifier) @property)
(circle name: (identifier) @property)
(curve name: (identifier) @property)
(binding name: (identifier) @property)
(binding coordinate: (identifier) @property)
(member name: (identifier) @property)
(function name: (identifier) @function)
(table name: (identifier) @function)
(function parameter: (identifier) @variable.parameter)
(curve parameter: (identifier) @variable.parameter)
(range index: (identifier) @variable.parameter)
(ground_word) @variable.builtin

; ---- words that have a meaning of their own

(call name: (identifier) @function.call)

; <words constants>
((reference) @constant.builtin
  (#any-of? @constant.builtin
    "t" "pi" "tau"))
; </words>

; <words units>
((reference) @type.builtin
  (#any-of? @type.builtin
    "m" "mm" "cm" "um" "µm" "km" "in" "ft" "rad" "mrad" "deg" "rev" "s" "ms" "us" "µs" "Hz" "rpm" "kg" "lbm"
    "N" "kN" "lbf" "J" "W" "kW" "Pa" "kPa" "MPa" "bar"))
; </words>

; <words functions>
((call name: (identifier) @function.builtin)
  (#any-of? @function.builtin
    "sin" "cos" "tan" "asin" "acos" "atan" "atan2" "sinh" "cosh" "tanh" "exp" "ln" "log10" "sqrt" "hypot"
    "abs" "sign" "min" "max" "mod" "der" "polar" "mid" "length" "direction" "step" "step5" "step7" "harmonic"
    "cycloidal" "modsine" "poly"))
; </words>

; <words quantities>
((call name: (identifier) @function.builtin)
  (#any-of? @function.builtin
    "x" "y" "angle" "distance" "rotation" "displacement" "curvature" "pole_x" "pole_y" "speed"
    "pressure_angle" "slip" "effort" "force_x" "force_y" "torque"))
; </words>

; <words reductions>
((call name: (identifier) @function.builtin)
  (#any-of? @function.builtin
    "max" "min" "argmax" "argmin" "mean" "rms" "integral" "first" "last" "at"))
; </words>

; <words joints>
((joint value: (call name: (identifier) @function.builtin))
  (#any-of? @function.builtin
    "revolute" "translational" "weld" "revolute_revolute" "revolute_translational" "gear" "internal_gear"
    "belt" "rack_pinion" "point_follower" "cam" "flat_follower"))
; </words>

; <words sides>
((joint value: (call arguments: (arguments (reference) @constant.builtin)))
  (#any-of? @constant.builtin
    "left" "right" "crossed"))
; </words>
