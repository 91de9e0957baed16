// The TextMate grammar: every word of the language has its scope, and a word that is a name has none.

const assert = require('node:assert');
const fs = require('node:fs');
const path = require('node:path');
const test = require('node:test');
const oniguruma = require('vscode-oniguruma');
const { Registry, parseRawGrammar, INITIAL } = require('vscode-textmate');

const file = path.join(__dirname, '../syntaxes/mech.tmLanguage.json');

async function load() {
  const wasm = fs.readFileSync(require.resolve('vscode-oniguruma/release/onig.wasm'));
  await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
  const onigLib = Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  });
  const registry = new Registry({ onigLib, loadGrammar: async () => parseRawGrammar(fs.readFileSync(file, 'utf8'), file) });
  return registry.loadGrammar('source.mech');
}

const grammar = load();

/** The tokens of a text, each with its innermost scope. */
async function tokens(text) {
  const found = [];
  let state = INITIAL;
  for (const line of text.split('\n')) {
    const result = (await grammar).tokenizeLine(line, state);
    for (const token of result.tokens) {
      found.push({ text: line.slice(token.startIndex, token.endIndex), scope: token.scopes.at(-1) });
    }
    state = result.ruleStack;
  }
  return found;
}

const SCOPES = {
  Keyword: /^(storage\.type|keyword\.other|keyword\.control|constant\.language)\./,
  Joint: /^support\.class\./,
  Quantity: /^support\.function\.quantity\./,
  Function: /^support\.function\.mech/,
  Motion: /^support\.function\.motion\./,
  Reduction: /^support\.function\.reduction\./,
  Unit: /^keyword\.other\.unit\./,
  Constant: /^(constant|variable)\.language\./,
};

// what their examples show in a comment only, because it takes a second file
const ELSEWHERE = {
  use: 'use "legs.mech" as walkers',
  as: 'use "legs.mech" as walkers',
  columns: 'table lift = spline "lift.csv" columns 1, 3 (s, mm)',
};

test('every word of the language has its scope', async () => {
  const words = JSON.parse(fs.readFileSync(path.join(__dirname, '../../test/words.json'), 'utf8'));
  assert.ok(words.length > 90);
  const without = [];
  for (const { name, category, example } of words) {
    const found = await tokens(ELSEWHERE[name] ?? example);
    const scopes = found.filter((token) => token.text === name).map((token) => token.scope);
    // with two arguments and more they are functions of numbers
    const wanted = ['max', 'min'].includes(name) ? /^support\.function\./ : SCOPES[category];
    if (!scopes.some((scope) => wanted.test(scope))) {
      without.push(`${name} (${category}): ${scopes}`);
    }
  }
  assert.deepStrictEqual(without, []);
});

/** The scopes of the words of a line, those without one left out. */
async function scopes(line) {
  const named = (await tokens(line)).filter((token) => token.scope !== 'source.mech' && /[\p{L}\d"]/u.test(token.text));
  return named.map((token) => `${token.text} ${token.scope.replace(/\.mech$/, '')}`);
}

const LINES = [
  ['    param at = to + on', ['param storage.type', 'at variable.other.constant']],
  ['body to at (0, 0, 5 deg) {', [
    'body storage.type', 'to entity.name.type', 'at keyword.other', '0 constant.numeric', '0 constant.numeric', '5 constant.numeric',
    'deg keyword.other.unit',
  ]],
  ['measure b = 5 in mm', [
    'measure storage.type', 'b variable.other.readwrite', '5 constant.numeric', 'in keyword.other', 'mm keyword.other.unit',
  ]],
  ['measure b = 5 in', ['measure storage.type', 'b variable.other.readwrite', '5 constant.numeric', 'in keyword.other.unit']],
  ['result c = at(trace, 0.5 s) in 1/m^2', [
    'result storage.type', 'c variable.other.readwrite', 'at support.function.reduction', '0.5 constant.numeric', 's keyword.other.unit',
    'in keyword.other', '1 constant.numeric', 'm keyword.other.unit', '2 constant.numeric',
  ]],
  ['joint j[k in 0..n]: gear(a.t, b[k].pi, 0, left)', [
    'joint storage.type', 'j variable.other.readwrite', 'in keyword.other', '0 constant.numeric', 'gear support.class',
    '0 constant.numeric', 'left constant.language',
  ]],
  ['part p: legs.gear(sin = 3) on ground at (0, 0, 0) mirrored', [
    'part storage.type', 'p variable.other.readwrite', 'legs entity.name.namespace', 'gear entity.name.type', '3 constant.numeric',
    'on keyword.other', 'ground variable.language', 'at keyword.other', '0 constant.numeric', '0 constant.numeric', '0 constant.numeric',
    'mirrored keyword.other',
  ]],
  ['fn part(input) = input * 2 // param', [
    'fn storage.type', 'part entity.name.function', 'input variable.parameter', '2 constant.numeric', '// param comment.line.double-slash',
  ]],
  ['param Δµm = 3 µm + länge(t)', [
    'param storage.type', 'Δµm variable.other.constant', '3 constant.numeric', 'µm keyword.other.unit', 'länge entity.name.function',
    't constant.language',
  ]],
  ['parameter.body.mm = ground_2', []],
  ['analysis from 0 s to T every -h', ['analysis storage.type', 'from keyword.other', '0 constant.numeric', 's keyword.other.unit',
    'to keyword.other', 'every keyword.other']],
];

for (const [line, wanted] of LINES) {
  test(line, async () => assert.deepStrictEqual(await scopes(line), wanted));
}
