'use strict';
// The runs of the page: their tables, and their states as arrays of numbers.

const report = JSON.parse(document.getElementById('data').textContent);

function decoded(text, Type) {
  return new Type(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
}

class Table {
  constructor(data) { this.columns = data.columns; this.values = data.values; }
  get rows() { return this.values.length ? this.values[0].length : 0; }
  has(name) { return this.columns.includes(name); }
  column(name) { return this.values[this.columns.indexOf(name)] || []; }
  at(name, row) { const c = this.column(name); return row < c.length ? c[row] : null; }
  /// Columns with numbers (true counts as 1) that are not all the same come first.
  numeric() {
    const numbers = this.columns.filter((c) => this.column(c).some((v) => typeof v === 'number' || typeof v === 'boolean'));
    const varies = (c) => new Set(this.column(c)).size > 1;
    return [...numbers.filter(varies), ...numbers.filter((c) => !varies(c))];
  }
}

class Run {
  constructor(data, number) {
    Object.assign(this, data);
    this.number = number;
    this.name = data.directory.replace(/\/+$/, '').split('/').pop() || data.title;
    for (const table of ['path', 'events']) this[table] = new Table(data[table]);
    if (data.curve) this.curve = Object.assign(new Table(data.curve), {of: data.curve.of, second: data.curve.second});
    this.parameter = this.in_time ? 'time' : 'lambda';
    this.states = data.states ? data.states.list : [];
    this.stored = data.states ? data.states.stored : 0;
    this.shape = data.structure ? decodedStructure(data.structure) : null;
    const ids = this.shape ? this.shape.id : [];
    this.index = new Map(Array.from(ids, (id, k) => [id, k]));
    for (const s of this.states) s.run = this;
  }

  /// The stored state that is nearest to a row: on its branch if there is one.
  nearest(row) {
    const branch = this.path.at('branch', row);
    let best = null, least = Infinity;
    for (const s of this.states) {
      const away = Math.abs(s.row - row) + (this.path.at('branch', s.row) === branch ? 0 : 1e6);
      if (away < least) [best, least] = [s, away];
    }
    return best;
  }

  /// A particle or body with this id as the program's sentences call it: "thin 19", "particle 7" of a data file.
  called(id) {
    const k = this.index.get(id), b = this.shape ? this.shape.bodies.findIndex((body) => body.id === id) : -1;
    const within = (n, first, count) => n !== undefined && n >= first && n < first + count;
    for (const s of this.shape && this.shape.structures || []) {
      if (s.kind === 'lammps') continue;
      if (within(k, s.first, s.count)) return `${s.name} ${k - s.first + 1}`;
      if (within(b, s.first_body, s.bodies)) return s.bodies > 1 ? `${s.name} ${b - s.first_body + 1}` : s.name;
    }
    return `${b >= 0 ? 'body' : 'particle'} ${id}`;
  }
}

function decodedStructure(s) {
  const set = (text) => new Set(decoded(text, Int32Array));
  return {...s, id: decoded(s.id, Int32Array), radius: decoded(s.radius, Float32Array), bonds: decoded(s.bonds, Int32Array),
    surfaces: s.surfaces.map((f) => ({points: decoded(f.points, Float32Array), triangles: decoded(f.triangles, Int32Array)})),
    stages: s.stages.map((t) => ({...t, absent: set(t.absent), unbound: set(t.unbound)}))};
}

/// The arrays of a state, made when they are first wanted.
function arrays(state) {
  if (state.arrays) return state.arrays;
  const a = state.arrays = {x: decoded(state.x, Float32Array), poses: decoded(state.poses, Float32Array),
    contacts: contactsOf(state.contacts),
    fields: Object.fromEntries(Object.entries(state.fields).map(([name, text]) => [name, decoded(text, Float32Array)])),
    modes: state.modes.map((m) => ({name: m.name, u: decoded(m.u, Float32Array), v: decoded(m.v, Float32Array)}))};
  a.fields.force = contactForces(a.contacts, state.run.index);
  return a;
}

/// Of every particle the size of the sum of its contact forces.
function contactForces(contacts, index) {
  const sums = Array.from(index, () => [0, 0, 0]);
  for (const c of contacts)
    for (const [id, sign] of [[c.first, 1], [c.second, -1]])
      if (index.has(id)) c.force.forEach((f, k) => { sums[index.get(id)][k] += sign * f; });
  return Float32Array.from(sums, (f) => Math.hypot(...f));
}

function contactsOf(text) {
  const pairs = decoded(text.pairs, Int32Array), numbers = decoded(text.numbers, Float32Array);
  return Array.from({length: pairs.length / 2}, (_, k) => {
    const [gap, fx, fy, fz, x, y, z] = numbers.subarray(7 * k, 7 * k + 7);
    return {first: pairs[2 * k], second: pairs[2 * k + 1], gap, force: [fx, fy, fz], size: Math.hypot(fx, fy, fz), point: [x, y, z]};
  });
}

const exponential = (v, digits) => v.toExponential(digits).replace(/\.?0*e/, 'e').replace('e+', 'e');
/// A number with seven digits, as short as it gets.
function short(v) {
  if (typeof v !== 'number') return `${v ?? ''}`;
  return v !== 0 && (Math.abs(v) < 1e-3 || Math.abs(v) >= 1e7) ? exponential(v, 6) : `${+v.toPrecision(7)}`;
}
/// Text of the ticks of a scale: powers of ten where numbers are long.
function ticks(scale) {
  const most = d3.max(scale.domain(), Math.abs);
  return most > 0 && (most < 1e-3 || most >= 1e6) ? (v) => (v === 0 ? '0' : exponential(v, 2)) : undefined;
}
/// Where a scale ends; numbers that agree to nine digits count as one.
function reach(values, room = 0) {
  const [lo, hi] = d3.extent(values);
  if (lo === undefined) return [0, 1];
  if (hi - lo <= 1e-9 * Math.max(Math.abs(lo), Math.abs(hi))) return lo === 0 ? [-1, 1] : [lo - Math.abs(lo) / 10, hi + Math.abs(hi) / 10];
  return [lo - room * (hi - lo), hi + room * (hi - lo)];
}
const plural = (n, word) => `${n} ${word}${n === 1 ? '' : 's'}`;

function kindOf(label) {
  const known = /^(?:(branch|limit|contact|jump):\d+|(initial|final))$/.exec(label || '');
  return known ? known[1] || known[2] : label ? 'event' : '';
}

const dark = () => matchMedia('(prefers-color-scheme: dark)').matches;

/// Colours that colour-blind readers can tell apart (after Okabe and Ito); those of saved figures are the light ones.
function theme(isDark = dark()) {
  return isDark ? {ink: '#e8ebef', quiet: '#a3adba', rule: '#373e48', page: '#14171b',
    series: ['#5fb3e6', '#f0b23c', '#3fc79a', '#e29cc4', '#9ad7f7', '#ff9a66'], index: ['#ff8a4d', '#e86fb1', '#b48cff', '#d6c23a']}
    : {ink: '#16191d', quiet: '#596270', rule: '#d5dae1', page: '#ffffff',
      series: ['#0072b2', '#e69f00', '#009e73', '#cc79a7', '#56b4e9', '#b85a1c'], index: ['#d55e00', '#b0307a', '#6a3fb5', '#8a7500']};
}
const seriesColour = (t, k) => t.series[k % t.series.length];
const indexColour = (t, negative) => t.index[Math.min(Math.max(negative, 1), t.index.length) - 1];

function save(name, parts, type) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([parts], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function element(tag, text, attributes = {}) {
  const e = document.createElement(tag);
  if (text !== undefined && text !== null) e.textContent = text;
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  return e;
}

function fill(select, entries, chosen) {
  select.replaceChildren(...entries.map(([value, text]) => { const o = element('option', text); o.value = value; return o; }));
  if (chosen !== undefined) select.value = chosen;
}
