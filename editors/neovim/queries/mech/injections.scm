; Comments may have marks such as TODO; doc comments are Markdown.

((comment) @injection.content
  (#set! injection.language "comment"))

((doc_comment) @injection.content
  (#set! injection.language "markdown_inline"))
