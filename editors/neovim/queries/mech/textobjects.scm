; A mechanism is a class, a declaration a function, and what stands between commas a parameter.

(mechanism body: (block) @class.inner) @class.outer
(body body: (features) @class.inner) @class.outer
(ground body: (features) @class.inner) @class.outer

[
  (param) (input) (part) (joint) (driver) (constraint) (gravity) (load) (measure) (trace) (result) (require) (analysis) (table)
  (point) (axis) (circle) (curve)
] @function.outer
(function value: (_) @function.inner) @function.outer
(param value: (_) @function.inner)
(measure value: (_) @function.inner)

(arguments (_) @parameter.inner)
(bindings (binding) @parameter.inner)
(rows (_) @parameter.inner)

[(comment) (doc_comment)] @comment.outer
