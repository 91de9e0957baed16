// Starts `mechc lsp` for .mech files, and runs mechc's commands as tasks.

const vscode = require('vscode');
const { LanguageClient } = require('vscode-languageclient/node');
const { argumentsOf, serverOf } = require('./commands');
const { Panels } = require('./panel');
const { quietAtStart } = require('./quiet');

const QuietClient = quietAtStart(LanguageClient);

/** @type {LanguageClient | undefined} */
let client;

const panels = new Panels(() => client);

/** What starts and stops the server, one after the other: a client that is starting cannot be stopped. @type {Promise<void>} */
let turns = Promise.resolve();

/** @returns {string} */
function path() {
  return vscode.workspace.getConfiguration('mechc').get('path') || 'mechc';
}

async function start() {
  // in a folder that nobody trusts nothing is run
  if (!vscode.workspace.isTrusted) {
    return;
  }
  const log = vscode.workspace.getConfiguration('mechc').get('log', '');
  const tried = path();
  client = new QuietClient('mechc', 'mechc', serverOf(tried, log), {
    documentSelector: [{ language: 'mech', scheme: 'file' }, { language: 'mech', scheme: 'untitled' }],
    // what the lenses above a mechanism may ask for
    initializationOptions: { commands: ['mechc.view', 'mechc.run', 'mechc.check'] },
    synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher('**/*.{mech,csv}') },
  });
  try {
    await client.start();
    panels.began(client);
  } catch (fault) {
    client = undefined;
    // where it is was said meanwhile, as happens where settings come late: another one is started
    if (tried === path()) {
      // not waited for: the rest of the extension works while the message stands
      void complain(fault);
    }
  }
}

/** @param {unknown} fault */
async function complain(fault) {
  const settings = 'Say Where It Is';
  const chosen = await vscode.window.showErrorMessage(`\`${path()} lsp\` does not start: ${fault}`, settings);
  if (chosen === settings) {
    await vscode.commands.executeCommand('workbench.action.openSettings', 'mechc.path');
  }
}

async function stop() {
  const running = client;
  client = undefined;
  // one that broke has nothing to end
  await running?.stop().catch(() => undefined);
}

function restart() {
  turns = turns.then(stop).then(start);
  return turns;
}

/**
 * A task that runs mechc on a file.
 * @param {'check' | 'run'} command
 * @param {string} file
 * @param {string | undefined} mechanism
 */
function task(command, file, mechanism) {
  const definition = { type: 'mechc', command, file, ...(mechanism ? { mechanism } : {}) };
  // without a shell: no name of a file means anything to it
  const execution = new vscode.ProcessExecution(path(), argumentsOf(command, file, mechanism));
  const made = new vscode.Task(definition, vscode.TaskScope.Workspace, `${command} ${mechanism ?? file}`, 'mechc', execution, '$mechc');
  made.presentationOptions = { clear: true, showReuseMessage: false };
  return made;
}

/**
 * The command of a code lens, of the palette or of the button above the text.
 * @param {'check' | 'run'} command
 */
function executed(command) {
  /** @param {string | vscode.Uri | undefined} place @param {unknown} mechanism */
  return async (place, mechanism) => {
    const uri = typeof place === 'string' ? vscode.Uri.parse(place) : place ?? vscode.window.activeTextEditor?.document.uri;
    if (uri?.scheme !== 'file') {
      await vscode.window.showInformationMessage('mechc reads files: save this text first.');
      return;
    }
    const document = vscode.workspace.textDocuments.find((one) => one.uri.toString() === uri.toString());
    if (document?.isDirty && !(await document.save())) {
      return;
    }
    await vscode.tasks.executeTask(task(command, uri.fsPath, typeof mechanism === 'string' ? mechanism : undefined));
  };
}

/** The page of a text. @param {string | vscode.Uri | undefined} place @param {unknown} mechanism */
async function view(place, mechanism) {
  const uri = typeof place === 'string' ? vscode.Uri.parse(place) : place ?? vscode.window.activeTextEditor?.document.uri;
  if (uri) {
    await panels.show(uri, typeof mechanism === 'string' ? mechanism : undefined);
  }
}

/** @param {vscode.TaskDefinition & { command?: 'check' | 'run', file?: string, mechanism?: string }} definition */
function resolved({ command, file, mechanism }) {
  return command && file ? task(command, file, mechanism) : undefined;
}

/** @param {vscode.ExtensionContext} context */
async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand('mechc.view', view),
    vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => panels.point(textEditor)),
    vscode.commands.registerCommand('mechc.run', executed('run')),
    vscode.commands.registerCommand('mechc.check', executed('check')),
    vscode.commands.registerCommand('mechc.restart', restart),
    vscode.commands.registerCommand('mechc.new', async () => {
      await vscode.window.showTextDocument(await vscode.workspace.openTextDocument({ language: 'mech' }));
    }),
    vscode.tasks.registerTaskProvider('mechc', {
      provideTasks: () => [],
      resolveTask: (one) => resolved(/** @type {any} */ (one.definition)),
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(restart),
    vscode.workspace.onDidChangeConfiguration(async (change) => {
      if (change.affectsConfiguration('mechc.path') || change.affectsConfiguration('mechc.log')) {
        await restart();
      }
    }),
  );
  await restart();
}

module.exports = { activate, deactivate: stop };
