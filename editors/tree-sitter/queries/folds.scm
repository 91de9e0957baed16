; What can be folded away.

[
  (block)
  (features)
  (rows)
  (bindings)
] @fold
(doc_comment)+ @fold
(comment)+ @fold
