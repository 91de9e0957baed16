; A mechanism is a class, a declaration a function, and what stands between commas a parameter.

(mechanism body: (block) @class.inside) @class.around
(body body: (features) @class.inside) @class.around
(ground body: (features) @class.inside) @class.around

[
  (param) (input) (part) (joint) (driver) (constraint) (gravity) (load) (measure) (trace) (result) (require) (analysis) (table)
  (point) (axis) (circle) (curve)
] @function.around
(function value: (_) @function.inside) @function.around
(param value: (_) @function.inside)
(measure value: (_) @function.inside)

(arguments (_) @parameter.inside)
(bindings (binding) @parameter.inside)
(rows (_) @parameter.inside)

[(comment) (doc_comment)] @comment.around
