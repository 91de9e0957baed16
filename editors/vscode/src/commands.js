// What mechc is started with; knows nothing of the editor.

/**
 * The arguments of a command.
 * @param {'check' | 'run'} command
 * @param {string} file
 * @param {string | undefined} mechanism which of the file's mechanisms, if it has several
 * @returns {string[]}
 */
function argumentsOf(command, file, mechanism) {
  return [command, ...(mechanism ? ['--mechanism', mechanism] : []), '--', file];
}

/**
 * How the language server is started.
 * @param {string} path
 * @param {string} log a file, or nothing
 */
function serverOf(path, log) {
  return { command: path, args: ['lsp', ...(log ? ['--log', log] : [])] };
}

module.exports = { argumentsOf, serverOf };
