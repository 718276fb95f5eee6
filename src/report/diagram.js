'use strict';
// The diagram: one column of the path against another.

/// Appends an SVG element with these attributes; null: without it.
const put = (parent, tag, attributes) => {
  const e = parent.append(tag);
  for (const [name, value] of Object.entries(attributes)) e.attr(name, value);
  return e;
};
const words = (parent, x, y, text, fill, more = {}) => put(parent, 'text', {x, y, fill, ...more}).text(text);
const atEnd = {'text-anchor': 'end'}, small = {'font-size': 11};
const haloed = (t) => ({'paint-order': 'stroke', stroke: t.page, 'stroke-width': 3});

/// An emptied svg, with the size that it has on the page, else this one.
function blank(svg, usualWidth, usualHeight, t = theme()) {
  const width = svg.clientWidth || usualWidth, height = svg.clientHeight || usualHeight, root = d3.select(svg);
  root.attr('viewBox', `0 0 ${width} ${height}`).selectAll('*').remove();
  return {t, root, width, height};
}

function axis(root, t, make, place, count) {
  const g = put(root, 'g', {transform: `translate(${place})`}).call(make.ticks(count).tickSizeOuter(0));
  g.selectAll('line, path').attr('stroke', t.rule);
  g.selectAll('text').attr('fill', t.quiet);
}

const asNumber = (v) => (typeof v === 'boolean' ? +v : v);
const inWords = (column) => (column === 'lambda' ? 'load factor' : column);

const symbols = {branch: d3.symbolDiamond, limit: d3.symbolTriangle, contact: d3.symbolCircle, jump: d3.symbolSquare,
  event: d3.symbolStar, initial: d3.symbolCross, final: d3.symbolWye};
const kindNames = {branch: 'branch point', limit: 'limit point', contact: 'contact made or lost', jump: 'end of a snap', event: 'event'};

/// The rows of a run that have both numbers: row, x, y, branch, negative, stable, label, kind.
function points(run, x, y) {
  const p = run.path, [xs, ys] = [p.column(x), p.column(y)];
  return d3.range(p.rows).filter((row) => Number.isFinite(asNumber(xs[row])) && Number.isFinite(asNumber(ys[row]))).map((row) => {
    const at = (column) => p.at(column, row), label = at('label') || '';
    return {row, x: asNumber(xs[row]), y: asNumber(ys[row]), branch: at('branch') || 0, parent: at('parent') || '',
      negative: at('negative') || 0, stable: p.has('stable') ? at('stable') : true, stage: at('stage'), label, kind: kindOf(label)};
  });
}

/// The curve in pieces of one branch, stability and Morse index, and the snaps between branches. At an event the stability is
/// that of the other end.
function pieces(all) {
  const lines = [], snaps = [], last = new Map(), named = new Map();
  const ordinary = (p) => !['branch', 'limit'].includes(p.kind);
  for (const p of all) {
    const previous = last.get(p.branch), before = previous && previous.stage === p.stage, from = before ? previous : named.get(p.parent);
    last.set(p.branch, p);
    if (p.label) named.set(p.label, p);
    if (!from) continue;
    if (!before && p.kind === 'jump') {
      snaps.push([from, p]);
      continue;
    }
    const q = ordinary(p) || !ordinary(from) ? p : from, piece = lines[lines.length - 1];
    const stable = q.stable || (!ordinary(q) && q.negative === 0), negative = stable ? 0 : Math.max(q.negative, ordinary(q) ? 0 : 1);
    const goesOn = piece && piece.branch === p.branch && piece.stable === stable && piece.negative === negative;
    if (goesOn && piece.points[piece.points.length - 1] === from) piece.points.push(p);
    else lines.push({branch: p.branch, stable, negative, points: [from, p]});
  }
  return {lines, snaps};
}

/// Draws into an svg of the given size; returns the scales. `view` is a zoom transform, `row` the chosen row.
function drawDiagram(svg, {run, others = [], x, y, width, height, view = d3.zoomIdentity, t = theme(), row = -1}) {
  const root = d3.select(svg), left = 72, right = width - 16, top = 44, bottom = height - 42;
  root.attr('viewBox', `0 0 ${width} ${height}`).attr('font-family', 'system-ui, DejaVu Sans, sans-serif').attr('font-size', 12);
  root.selectAll('*').remove();
  const all = points(run, x, y), ghosts = others.map((r) => points(r, x, y));
  const domain = (get) => reach([...all, ...ghosts.flat()].map(get), 0.05);
  const sx = view.rescaleX(d3.scaleLinear(domain((p) => p.x), [left, right]));
  const sy = view.rescaleY(d3.scaleLinear(domain((p) => p.y), [bottom, top]));
  put(root.append('clipPath').attr('id', 'inside'), 'rect', {x: left, y: top, width: Math.max(0, right - left), height: bottom - top});
  axis(root, t, d3.axisBottom(sx).tickFormat(ticks(sx)), [0, bottom], width / 90);
  axis(root, t, d3.axisLeft(sy).tickFormat(ticks(sy)), [left, 0], height / 55);
  words(root, right, height - 8, inWords(x), t.ink, atEnd);
  words(root, 8, 16, inWords(y), t.ink);

  const inside = put(root, 'g', {'clip-path': 'url(#inside)'}), line = d3.line().x((p) => sx(p.x)).y((p) => sy(p.y));
  const curve = (of, stroke, wide, dashes = null) =>
    put(inside, 'path', {d: line(of), fill: 'none', stroke, 'stroke-width': wide, 'stroke-dasharray': dashes, 'stroke-linejoin': 'round'});
  for (const other of ghosts) for (const l of pieces(other).lines) curve(l.points, t.rule, 1.2);
  const {lines, snaps} = pieces(all);
  for (const f of snaps) curve(f, t.quiet, 1.2, '1.5 3');
  for (const l of lines) curve(l.points, ...(l.stable ? [seriesColour(t, l.branch), 3] : [indexColour(t, l.negative), 1.8, '6 4']));
  if (!lines.length) for (const p of all) put(inside, 'circle', {cx: sx(p.x), cy: sy(p.y), r: 3, fill: t.series[0]});

  const marks = all.filter((p) => p.kind), taken = [];
  for (const p of marks) {
    const size = p.kind === 'initial' || p.kind === 'final' ? 40 : 80;
    put(inside, 'path', {class: 'mark', ...symbol(p.kind, size, t), transform: `translate(${sx(p.x)},${sy(p.y)})`, 'stroke-width': 1.5})
      .append('title').text(p.label);
    const half = 3.4 * p.label.length, middle = Math.min(Math.max(sx(p.x), left + half), right - half);
    const clear = (b) => b.y > top + 8 && b.y < bottom && !taken.some((c) => b.lo < c.hi && b.hi > c.lo && Math.abs(b.y - c.y) < 13);
    const free = [-11, 20].map((dy) => ({lo: middle - half, hi: middle + half, y: sy(p.y) + dy})).find(clear);
    if (!free || marks.length > 40) continue;
    taken.push(free);
    words(inside, middle, free.y, p.label, t.quiet, {'text-anchor': 'middle', ...small, ...haloed(t)});
  }
  legend(root, t, lines, new Set(marks.map((p) => p.kind)), right);
  const here = all.find((p) => p.row === row), ring = {r: 7, fill: t.index[0], 'fill-opacity': 0.35, stroke: t.index[0], 'stroke-width': 2};
  if (here) put(inside, 'circle', {class: 'here', cx: sx(here.x), cy: sy(here.y), ...ring});
  return {sx, sy, all};
}

const symbol = (kind, size, t) =>
  ({d: d3.symbol().type(symbols[kind]).size(size)(), fill: kind === 'contact' ? t.page : t.ink, stroke: t.ink});

function legend(root, t, lines, kinds, right) {
  const unstable = [...new Set(lines.filter((l) => !l.stable).map((l) => l.negative))].sort((a, b) => a - b);
  const entries = unstable.map((n) => ({text: `unstable, index ${n}`, line: [indexColour(t, n), 1.8, '6 4']}));
  if (unstable.length && lines.some((l) => l.stable)) entries.unshift({text: 'stable', line: [t.ink, 3, null]});
  for (const [kind, text] of Object.entries(kindNames)) if (kinds.has(kind)) entries.push({text, kind});
  const sizes = entries.map((e) => 26 + 6.3 * e.text.length);
  let at = Math.max(60, right - d3.sum(sizes)), y = 30;
  entries.forEach((e, k) => {
    if (at + sizes[k] > right + 4) { at = 60; y += 14; }
    const [stroke, wide, dashes] = e.line || [];
    if (e.line) put(root, 'line', {x1: at, x2: at + 18, y1: y - 4, y2: y - 4, stroke, 'stroke-width': wide, 'stroke-dasharray': dashes});
    else put(root, 'path', {...symbol(e.kind, 60, t), transform: `translate(${at + 10},${y - 4})`});
    words(root, at + 22, y, e.text, t.quiet, small);
    at += sizes[k];
  });
}

/// The diagram on the page: zoom, the row under the pointer, the row that is chosen.
class Diagram {
  constructor(svg, tip, choose) {
    Object.assign(this, {svg, tip, choose, view: d3.zoomIdentity, row: 0, others: []});
    const wheel = () => d3.event.ctrlKey || document.activeElement === svg;
    const wanted = () => (d3.event.type === 'wheel' ? wheel() : d3.event.type !== 'dblclick' && !this.near(d3.event, 40));
    this.zoom = d3.zoom().scaleExtent([1, 1e4]).filter(wanted).on('zoom', () => { this.view = d3.event.transform; this.draw(); });
    d3.select(svg).call(this.zoom);
    svg.addEventListener('pointerdown', (e) => { if (e.button === 0) { this.dragging = !!this.near(e, 40); this.follow(e); } });
    svg.addEventListener('pointermove', (e) => this.follow(e));
    svg.addEventListener('pointerup', () => { this.dragging = false; });
    svg.addEventListener('pointerleave', () => { this.dragging = false; this.tip.hidden = true; });
    new ResizeObserver(() => this.draw()).observe(svg);
  }

  show(run, x, y, others) { Object.assign(this, {run, x, y, others}); this.fit(); }
  fit() { d3.select(this.svg).call(this.zoom.transform, d3.zoomIdentity); }
  by(factor) { d3.select(this.svg).call(this.zoom.scaleBy, factor); }
  select(row) { this.row = row; this.draw(); }
  size() { return {width: this.svg.clientWidth || 600, height: this.svg.clientHeight || 460}; }

  draw() {
    if (!this.run) return;
    const {width, height} = this.size();
    this.scales = drawDiagram(this.svg, {...this, width, height, t: theme()});
  }

  near(e, reach) {
    if (!this.scales) return null;
    const box = this.svg.getBoundingClientRect(), touch = e.touches ? e.touches[0] : e;
    let best = null, least = reach;
    for (const p of this.scales.all) {
      const away = Math.hypot(this.scales.sx(p.x) - (touch.clientX - box.left), this.scales.sy(p.y) - (touch.clientY - box.top));
      if (away < least) [best, least] = [p, away];
    }
    return best;
  }

  follow(e) {
    const p = this.near(e, this.dragging ? Infinity : 24);
    if (p && this.dragging) this.choose(p.row);
    this.tip.hidden = !p;
    if (!p) return;
    const values = this.run.path.columns.filter((c) => c !== 'label').map((c) => [c, this.run.path.at(c, p.row)])
      .filter(([, v]) => v !== null && v !== '');
    this.tip.replaceChildren(element('b', p.label || `point ${p.row}`),
      ...values.flatMap(([c, v]) => [element('i', c), element('span', short(v))]));
    const {width} = this.size(), left = this.scales.sx(p.x);
    this.tip.style.top = '8px';
    this.tip.style.left = left < width / 2 ? `${left + 24}px` : '';
    this.tip.style.right = left < width / 2 ? '' : `${width - left + 24}px`;
  }

  /// The figure as a file of its own, dark on light.
  svgText() {
    const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg'), {width, height} = this.size(), t = theme(false);
    drawDiagram(svg, {...this, row: -1, width, height, t});
    const root = d3.select(svg).attr('width', width).attr('height', height);
    root.insert('rect', ':first-child').attr('width', width).attr('height', height).attr('fill', t.page);
    root.insert('title', ':first-child').text(`${this.run.title}: ${this.y} against ${this.x}`);
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + new XMLSerializer().serializeToString(svg);
  }

  /// The rows that are in view.
  csvText() {
    const columns = [...new Set(['step', 'label', 'branch', this.x, this.y, 'negative', 'stable'])].filter((c) => this.run.path.has(c));
    const {sx, sy, all} = this.scales, within = (s, v) => v >= d3.min(s.domain()) && v <= d3.max(s.domain());
    const quoted = (v) => (v === null ? '' : /[",\r\n]/.test(v) ? `"${v.replace(/"/g, '""')}"` : `${v}`);
    const rows = all.filter((p) => within(sx, p.x) && within(sy, p.y))
        .map((p) => columns.map((c) => quoted(this.run.path.at(c, p.row))).join(','));
    return [columns.join(','), ...rows].join('\n') + '\n';
  }
}
