; What stands between braces or brackets is indented.

[
  (block)
  (features)
  (rows)
  (bindings)
  (arguments)
  (tuple)
  (parenthesized)
] @indent

["}" "]" ")"] @outdent
