; What stands between braces or brackets is indented.

[
  (block)
  (features)
  (rows)
  (bindings)
  (arguments)
  (tuple)
  (parenthesized)
] @indent.begin

["}" "]" ")"] @indent.branch
["}" "]" ")"] @indent.end
[(comment) (doc_comment)] @indent.auto
