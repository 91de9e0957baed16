; A mechanism has a space of names, a body one of its own within, and so has what takes an argument.

[
  (mechanism)
  (features)
  (function)
  (curve)
] @local.scope

(mechanism name: (identifier) @local.definition.type)
(param name: (identifier) @local.definition.constant)
(function name: (identifier) @local.definition.function)
(function parameter: (identifier) @local.definition.parameter)
(table name: (identifier) @local.definition.function)
(body name: (identifier) @local.definition.type)
(curve name: (identifier) @local.definition.field)
(curve parameter: (identifier) @local.definition.parameter)
(range index: (identifier) @local.definition.parameter)
[
  (point name: (identifier) @local.definition.field)
  (axis name: (identifier) @local.definition.field)
  (circle name: (identifier) @local.definition.field)
]
[
  (input name: (identifier) @local.definition.var)
  (part name: (identifier) @local.definition.var)
  (joint name: (identifier) @local.definition.var)
  (driver name: (identifier) @local.definition.var)
  (constraint name: (identifier) @local.definition.var)
  (measure name: (identifier) @local.definition.var)
  (load name: (identifier) @local.definition.var)
  (trace name: (identifier) @local.definition.var)
  (result name: (identifier) @local.definition.var)
  (require name: (identifier) @local.definition.var)
]

(reference) @local.reference
(call name: (identifier) @local.reference)
