// What can be tested of the extension without an editor: what it starts, what it promises, what its problem matcher reads.

const assert = require('node:assert');
const { execFileSync, spawnSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const test = require('node:test');
const { argumentsOf, serverOf } = require('../src/commands');
const { quietAtStart } = require('../src/quiet');

const root = path.join(__dirname, '..');
const manifest = JSON.parse(fs.readFileSync(path.join(root, 'package.json'), 'utf8'));

test('commands name the file last, so that no name of a file is an option', () => {
  assert.deepStrictEqual(argumentsOf('run', '-x.mech', undefined), ['run', '--', '-x.mech']);
  assert.deepStrictEqual(argumentsOf('check', '/a b.mech', 'arm'), ['check', '--mechanism', 'arm', '--', '/a b.mech']);
  assert.deepStrictEqual(serverOf('mechc', ''), { command: 'mechc', args: ['lsp'] });
  assert.deepStrictEqual(serverOf('/opt/mechc', 'log'), { command: '/opt/mechc', args: ['lsp', '--log', 'log'] });
});

test('a server that does not start is complained of once, and one that breaks later is still heard of', async () => {
  /** @type {[string, unknown][]} */
  const said = [];
  class Client {
    /** @param {string} message @param {any} [_data] @param {boolean | 'force'} [shown] */
    error(message, _data, shown) {
      said.push([message, shown]);
    }

    async start() {
      this.error('not found', undefined, 'force');
      throw new Error('not found');
    }
  }
  const client = new (quietAtStart(Client))();
  await assert.rejects(client.start(), /not found/);
  client.error('broken', undefined, 'force');
  assert.deepStrictEqual(said, [['not found', false], ['broken', 'force']]);
});

test('no folder can choose what is started', () => {
  for (const [name, setting] of Object.entries(manifest.contributes.configuration.properties)) {
    assert.ok(['mechc.trace.server'].includes(name) || setting.scope === 'machine', name);
  }
  assert.strictEqual(manifest.capabilities.untrustedWorkspaces.supported, 'limited');
});

test('every file that the manifest names is there', () => {
  const { languages, grammars, snippets, walkthroughs } = manifest.contributes;
  const media = walkthroughs.flatMap((one) => one.steps.map((step) => step.media.markdown));
  const named = [manifest.icon, languages[0].configuration, grammars[0].path, snippets[0].path, ...media];
  for (const file of named) {
    assert.ok(fs.existsSync(path.join(root, file)), file);
  }
});

test('every command of the manifest is registered, and no other', () => {
  const source = fs.readFileSync(path.join(root, 'src/extension.js'), 'utf8');
  const registered = [...source.matchAll(/registerCommand\('([^']*)'/g)].map((match) => match[1]).sort();
  assert.deepStrictEqual(manifest.contributes.commands.map((command) => command.command).sort(), registered);
});

test('regular expressions of the language configuration', () => {
  const { wordPattern, indentationRules } = JSON.parse(fs.readFileSync(path.join(root, 'language-configuration.json'), 'utf8'));
  // as the editor reads it: a string alone has no flags, and without `u` it knows no letters
  const { pattern, flags } = typeof wordPattern === 'string' ? { pattern: wordPattern, flags: '' } : wordPattern;
  const word = new RegExp(pattern, `${flags}g`);
  assert.deepStrictEqual('länge_1 * 2.5e3 mm'.match(word), ['länge_1', '2.5e3', 'mm']);
  const more = new RegExp(indentationRules.increaseIndentPattern);
  const less = new RegExp(indentationRules.decreaseIndentPattern);
  assert.ok(more.test('mechanism a {') && more.test('    body b at (0, 0, 0) { // here') && more.test('table t = spline ['));
  assert.ok(!more.test('    point O = (0, 0)') && !more.test('// a {') && !more.test('ground { point O = (0, 0) }'));
  assert.ok(less.test('    }') && !less.test('    point O = (0, 0)'));
});

const mechc = process.env.MECHC ?? path.join(root, '../../target/debug/mechc');

test('the problem matcher reads what mechc says', { skip: !fs.existsSync(mechc) && `${mechc} is not built` }, () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'mech-'));
  const file = path.join(folder, 'a.mech');
  fs.writeFileSync(file, 'mechanism a {\n    param b = 3 mm + 2 s\n}\n');
  const said = spawnSync(mechc, argumentsOf('check', file, undefined), { encoding: 'utf8' }).stderr;
  const [first, second] = manifest.contributes.problemMatchers[0].pattern.map((one) => new RegExp(one.regexp, 'm'));
  const at = said.indexOf('error[E0401]');
  assert.deepStrictEqual(said.slice(at).match(first)?.slice(1), ['error', 'E0401', 'this adds a length and a time']);
  assert.deepStrictEqual(said.slice(at).match(second)?.slice(1), [file, '2', '22'], said);
  fs.rmSync(folder, { recursive: true });
});

test('the bundle is that of the sources, and needs nothing but the editor', { skip: !fs.existsSync(path.join(root, 'node_modules')) }, () => {
  execFileSync('npm', ['run', '--silent', 'build'], { cwd: root, stdio: 'pipe' });
  const bundle = fs.readFileSync(path.join(root, 'dist/extension.js'), 'utf8');
  const needed = new Set([...bundle.matchAll(/require\("([^"]*)"\)/g)].map((match) => match[1].replace(/^node:/, '')));
  const builtin = new Set(require('node:module').builtinModules);
  assert.deepStrictEqual([...needed].filter((name) => !builtin.has(name)), ['vscode']);
});
