/**
 * The grammar of `.mech` files for editors. `grammar/mech.pest` is the grammar of the language; nodes are named as its rules.
 *
 * It takes more than the language does, so that what surrounds a mistake keeps its shape: declarations may end early, as they do while
 * they are written, or stand outside a mechanism, features outside a body, `use` behind a mechanism. What is refused `mechc` says.
 */

// no name can be one of these
// <words reserved>
const RESERVED = [
  'mechanism', 'param', 'fn', 'table', 'ground', 'body', 'point', 'axis', 'circle', 'curve', 'joint',
  'driver', 'constraint', 'measure', 'analysis', 'if', 'then', 'else', 'and', 'or', 'not',
];
// </words>

// words that a number may stand before, and that are not its unit; names elsewhere
// <words separators>
const SEPARATORS = [
  'to', 'every', 'within', 'along', 'at', 'toward', 'radius', 'inertia', 'from', 'on',
];
// </words>

// words that begin a declaration where one begins; names elsewhere, but no unit
// <words openers>
const OPENERS = [
  'use', 'mass', 'gravity', 'load', 'trace', 'result', 'require', 'input', 'part',
];
// </words>

// loosest first
const PRECEDENCE = { or: 1, and: 2, not: 3, compare: 4, sum: 5, product: 6, sign: 7, power: 8 };

const list = (item) => seq(item, repeat(seq(',', item)));

const is = ($) => seq('=', field('value', $.expression));

// parts one after the other, of which the last ones may not be written yet
const begun = (...parts) => parts.reduceRight((rest, part) => optional(rest ? seq(part, rest) : part), null);

// behind the comma of a call these begin a window, or are names as they are elsewhere
const name_too = (name) => choice(alias('from', name), alias('to', name));

module.exports = grammar({
  name: 'mech',

  word: $ => $.identifier,

  reserved: {
    global: _ => RESERVED,
    unit: _ => [...RESERVED, ...SEPARATORS, ...OPENERS],
  },

  extras: $ => [/\p{White_Space}/, $.doc_comment, $.comment],

  supertypes: $ => [$.expression],

  inline: $ => [$._place],

  // `5 in mm` is five, printed in millimetres; `5 in` is five inches
  conflicts: $ => [[$.quantity], [$._reference, $.window]],

  rules: {
    source_file: $ => repeat(choice($.use, $.mechanism, $._item, $._feature)),

    use: $ => seq('use', begun(field('path', $.string), seq('as', field('prefix', $.identifier)))),

    mechanism: $ => seq('mechanism', field('name', $.identifier), begun(field('body', $.block))),
    block: $ => seq('{', repeat(choice($._item, $._feature)), '}'),

    _item: $ => choice(
      $.param, $.function, $.table, $.input, $.part, $.ground, $.body, $.joint, $.driver, $.constraint, $.gravity, $.load,
      $.measure, $.trace, $.result, $.require, $.analysis,
    ),
    _feature: $ => choice($.point, $.axis, $.circle, $.curve, $.mass),

    // ---- declarations

    param: $ => seq('param', field('name', $.identifier), begun(is($))),

    function: $ => seq('fn', field('name', $.identifier), begun($._argument, is($))),
    _argument: $ => seq('(', field('parameter', $.identifier), ')'),

    table: $ => seq(
      'table', field('name', $.identifier),
      begun('=', seq(optional('periodic'), 'spline'), field('value', choice($.rows, $.table_file))),
    ),
    rows: $ => seq('[', optional(seq(list($.expression), optional(','))), ']'),
    table_file: $ => seq(
      field('path', $.string),
      optional($.columns),
      optional(seq('(', $.unit_product, ',', $.unit_product, optional(','), ')')),
    ),
    columns: $ => seq('columns', $._column, ',', $._column),
    _column: $ => choice($.number, $.string),

    input: $ => seq('input', $._repeated_name, begun(is($))),

    part: $ => seq(
      'part', $._repeated_name,
      begun(
        seq(':', field('mechanism', $.mechanism_name)),
        seq(
          field('bindings', $.bindings),
          optional(seq('on', field('carrier', choice($._reference, $.ground_word, $.member)))),
          optional(seq('at', field('pose', $._parenthesized))),
          optional('mirrored'),
        ),
      ),
    ),
    mechanism_name: $ => seq(optional(seq(field('prefix', $.identifier), '.')), field('name', $.identifier)),
    bindings: $ => seq('(', optional(seq(list($.binding), optional(','))), ')'),
    binding: $ => seq(
      field('name', $.identifier), optional(seq('.', field('coordinate', $.identifier))), '=', field('value', $.expression),
    ),

    ground: $ => seq('ground', begun(field('body', $.features))),
    body: $ => seq('body', $._repeated_name, optional($._place), begun(field('body', $.features))),
    _place: $ => seq('at', field('pose', $.expression), optional(seq('toward', field('target', $.expression)))),
    features: $ => seq('{', repeat($._feature), '}'),

    // alone it is the mechanism's point of its name
    point: $ => seq('point', field('name', $.identifier), optional(is($))),
    axis: $ => seq(
      'axis', field('name', $.identifier),
      begun(is($), choice(seq('along', field('direction', $._parenthesized)), seq('to', field('target', $.expression)))),
    ),
    circle: $ => seq('circle', field('name', $.identifier), begun(is($), seq('radius', field('radius', $.expression)))),
    curve: $ => seq(
      'curve', field('name', $.identifier),
      begun($._argument, seq(is($), optional(seq('at', field('estimate', $.expression))))),
    ),
    // a name elsewhere: alone it is none of these
    mass: $ => seq(
      'mass', field('mass', $.expression),
      optional(seq('at', field('center', $.expression))), optional(seq('inertia', field('inertia', $.expression))),
    ),

    joint: $ => seq('joint', $._repeated_name, begun(seq(':', field('value', choice($.call, $._reference))))),
    driver: $ => seq('driver', $._repeated_name, begun(seq(':', field('left', $.expression)), seq('=', field('right', $.expression)))),
    constraint: $ => seq(
      'constraint', $._repeated_name, begun(seq(':', field('left', $.expression)), seq('=', field('right', $.expression))),
    ),
    gravity: $ => seq('gravity', field('acceleration', $._parenthesized)),
    load: $ => seq('load', $._repeated_name, begun(seq(':', field('force', $.expression)), seq('on', field('quantity', $.expression)))),
    measure: $ => seq('measure', $._repeated_name, begun(seq(is($), optional($.printed)))),
    trace: $ => seq('trace', $._repeated_name, begun(seq(is($), optional($.printed)))),
    result: $ => seq('result', $._repeated_name, begun(seq(is($), optional($.printed)))),
    require: $ => seq(
      'require', optional(seq(field('name', $.identifier), ':')),
      // alone the word is a name
      field('condition', $.expression), optional(seq('within', field('tolerance', $.expression))),
    ),
    printed: $ => seq('in', $.unit_product),
    analysis: $ => seq(
      'analysis',
      begun(
        seq('from', field('from', $.expression)),
        seq('to', field('to', $.expression)),
        seq('every', field('every', $.expression)),
      ),
    ),

    // one declaration for each whole number
    _repeated_name: $ => seq(field('name', $.identifier), optional(field('ranges', $.ranges))),
    ranges: $ => seq('[', list($.range), ']'),
    range: $ => seq(
      field('index', $.identifier), 'in', field('start', $.expression), choice('..', '..='), field('end', $.expression),
    ),

    // ---- formulas

    expression: $ => choice($._operand, $.conditional),
    conditional: $ => prec.right(seq(
      'if', field('condition', $.expression),
      begun(seq('then', field('then', $.expression)), seq('else', field('else', $.expression))),
    )),
    _operand: $ => choice(
      $.binary, $.unary, $.parenthesized, $.tuple, $.quantity, $.member, $.call, $._reference,
    ),
    unary: $ => choice(
      prec(PRECEDENCE.not, seq('not', field('operand', $._operand))),
      prec(PRECEDENCE.sign, seq('-', field('operand', $._operand))),
    ),
    binary: $ => choice(
      ...[
        ['or', PRECEDENCE.or],
        ['and', PRECEDENCE.and],
        ...['<', '<=', '>', '>=', '==', '!='].map(operator => [operator, PRECEDENCE.compare]),
        ...['+', '-'].map(operator => [operator, PRECEDENCE.sum]),
        ...['*', '/'].map(operator => [operator, PRECEDENCE.product]),
      ].map(([operator, level]) => prec.left(level, seq(field('left', $._operand), field('operator', operator), field('right', $._operand)))),
      prec.right(PRECEDENCE.power, seq(field('left', $._operand), field('operator', '^'), field('right', $._operand))),
    ),
    // one expression, or several: a point, a pose, a row of a table
    _parenthesized: $ => choice($.parenthesized, $.tuple),
    parenthesized: $ => seq('(', $.expression, ')'),
    tuple: $ => seq('(', $.expression, choice(',', seq(repeat1(seq(',', $.expression)), optional(','))), ')'),

    call: $ => choice(
      seq(field('name', $.identifier), field('arguments', $.arguments)),
      // a bracket that stands apart begins a time
      seq(field('name', name_too($.identifier)), field('arguments', alias($._arguments_at_once, $.arguments))),
    ),
    arguments: $ => seq('(', $._listed_arguments),
    _arguments_at_once: $ => seq(token.immediate('('), $._listed_arguments),
    _listed_arguments: $ => seq(optional(seq(list($.expression), optional(seq(',', $.window)), optional(','))), ')'),
    // the part of the analysis that a reduction takes
    window: $ => prec.dynamic(1, choice(
      seq('from', field('from', $.expression), optional(seq('to', field('to', $.expression)))),
      seq('to', field('to', $.expression)),
    )),

    member: $ => choice(
      seq(field('object', choice($._reference, $.ground_word, $.member)), '.', field('name', choice($.identifier, $.ground_word))),
      seq(field('object', choice($._reference, $.member)), field('indices', $.indices)),
    ),
    indices: $ => seq('[', list($.expression), ']'),
    ground_word: _ => 'ground',

    // ---- numbers and units

    quantity: $ => seq($.number, optional(seq($._unit_of_number, optional($._power)))),
    _unit_of_number: $ => choice(alias(reserved('unit', $.identifier), $.unit), alias('in', $.unit)),
    unit_product: $ => prec.left(seq(optional(seq('1', '/')), $._factor, repeat(seq(choice('*', '/'), $._factor)))),
    _factor: $ => prec.left(seq(alias(reserved('unit', $.identifier), $.unit), optional($._power))),
    _power: $ => seq('^', $.exponent),
    exponent: _ => /-?[0-9]+/,
    number: _ => /([0-9]+(\.[0-9]+)?|\.[0-9]+)([eE][+-]?[0-9]+)?/,

    // ---- words

    // where a name is used it is no identifier, but a reference
    _reference: $ => choice(alias($.identifier, $.reference), name_too($.reference)),
    identifier: _ => /[\p{XID_Start}_]\p{XID_Continue}*/,
    string: _ => /"[^"\n]*"/,
    doc_comment: _ => token(prec(1, /\/\/\/[^\n]*/)),
    comment: _ => token(/\/\/[^\n]*/),
  },
});
