'use strict';
// The diagram: one column of the path against another.

const symbols = {branch: d3.symbolDiamond, limit: d3.symbolTriangle, contact: d3.symbolCircle, jump: d3.symbolSquare, event: d3.symbolStar,
    initial: d3.symbolCross,
  final: d3.symbolWye};
const kindNames = {branch: 'branch point', limit: 'limit point', contact: 'contact made or lost', jump: 'end of a snap',
    event: 'event', initial: 'start', final: 'end'};

/// The rows of a run that have both numbers: row, x, y, branch, negative, stable, label, kind.
function points(run, x, y) {
  const p = run.path, number = (v) => (typeof v === 'boolean' ? +v : v), all = [];
  const [xs, ys] = [p.column(x), p.column(y)];
  for (let row = 0; row < p.rows; ++row) {
    if (!Number.isFinite(number(xs[row])) || !Number.isFinite(number(ys[row]))) continue;
    const label = p.at('label', row) || '';
    all.push({row, x: number(xs[row]), y: number(ys[row]), branch: p.at('branch', row) || 0, parent: p.at('parent', row) || '',
      negative: p.at('negative', row) || 0, stable: p.has('stable') ? p.at('stable', row) : true, stage: p.at('stage', row), label,
          kind: kindOf(label)});
  }
  return all;
}

/// The curve in pieces of one branch, stability and Morse index, and the snaps between branches. At an event the stability is
/// that of the other end.
function pieces(all) {
  const lines = [], snaps = [], last = new Map(), named = new Map();
  const ordinary = (p) => !['branch', 'limit'].includes(p.kind);
  for (const p of all) {
    const same = (q) => (q && q.stage === p.stage ? q : null), before = same(last.get(p.branch)), from = before
        || (p.parent ? named.get(p.parent) : null);
    if (from) {
      const q = ordinary(p) || !ordinary(from) ? p : from;
      const stable = q.stable || (!ordinary(q) && q.negative === 0), negative = stable ? 0 : Math.max(q.negative, ordinary(q) ? 0 : 1);
      if (!before && p.kind === 'jump') snaps.push([from, p]);
      else {
        const piece = lines.length ? lines[lines.length - 1] : null;
        if (piece && piece.branch === p.branch && piece.stable === stable && piece.negative === negative
            && piece.points[piece.points.length - 1] === from)
          piece.points.push(p);
        else lines.push({branch: p.branch, stable, negative, points: [from, p]});
      }
    }
    last.set(p.branch, p);
    if (p.label) named.set(p.label, p);
  }
  return {lines, snaps};
}

/// Draws into an svg of the given size; returns the scales. `view` is a zoom transform, `row` the chosen row.
function drawDiagram(svg, {run, others = [], x, y, width, height, view = d3.zoomIdentity, t = theme(), row = -1}) {
  const root = d3.select(svg).attr('viewBox', `0 0 ${width} ${height}`).attr('font-family', 'system-ui, DejaVu Sans, sans-serif')
      .attr('font-size', 12);
  root.selectAll('*').remove();
  const all = points(run, x, y), ghosts = others.flatMap((r) => points(r, x, y));
  const margin = {left: 72, right: 16, top: 44, bottom: 42};
  const domain = (get) => reach([...all, ...ghosts].map(get), 0.05);
  const sx = view.rescaleX(d3.scaleLinear(domain((p) => p.x), [margin.left, width - margin.right]));
  const sy = view.rescaleY(d3.scaleLinear(domain((p) => p.y), [height - margin.bottom, margin.top]));
  root.append('clipPath').attr('id', 'inside').append('rect').attr('x', margin.left).attr('y', margin.top)
    .attr('width', Math.max(0, width - margin.left - margin.right)).attr('height', height - margin.top - margin.bottom);
  const axis = (g, make, count) => g.call(make.ticks(count).tickFormat(ticks(make.scale())).tickSizeOuter(0))
      .call((a) => a.selectAll('line, path').attr('stroke', t.rule))
    .call((a) => a.selectAll('text').attr('fill', t.quiet));
  axis(root.append('g').attr('transform', `translate(0,${height - margin.bottom})`), d3.axisBottom(sx), width / 90);
  axis(root.append('g').attr('transform', `translate(${margin.left},0)`), d3.axisLeft(sy), height / 55);
  root.append('text').attr('x', width - margin.right).attr('y', height - 8).attr('text-anchor', 'end').attr('fill', t.ink)
      .text(x === 'lambda' ? 'load factor' : x);
  root.append('text').attr('x', 8).attr('y', 16).attr('fill', t.ink).text(y === 'lambda' ? 'load factor' : y);

  const inside = root.append('g').attr('clip-path', 'url(#inside)');
  const line = d3.line().x((p) => sx(p.x)).y((p) => sy(p.y));
  for (const other of others)
    for (const l of pieces(points(other, x, y)).lines)
      inside.append('path').attr('d', line(l.points)).attr('fill', 'none').attr('stroke', t.rule).attr('stroke-width', 1.2);
  const {lines, snaps} = pieces(all);
  for (const f of snaps)
    inside.append('path').attr('d', line(f)).attr('fill', 'none').attr('stroke', t.quiet).attr('stroke-width', 1.2)
        .attr('stroke-dasharray', '1.5 3');
  for (const l of lines)
    inside.append('path').attr('d', line(l.points)).attr('fill', 'none').attr('stroke-linejoin', 'round')
      .attr('stroke', l.stable ? seriesColour(t, l.branch) : indexColour(t, l.negative)).attr('stroke-width', l.stable ? 3 : 1.8)
      .attr('stroke-dasharray', l.stable ? null : '6 4');
  if (all.length === 1 || !lines.length) for (const p of all) inside.append('circle').attr('cx', sx(p.x)).attr('cy', sy(p.y)).attr('r', 3)
      .attr('fill', t.series[0]);

  const marks = all.filter((p) => p.kind), taken = [];
  for (const p of marks) {
    inside.append('path').attr('class', 'mark').attr('d', d3.symbol().type(symbols[p.kind]).size(p.kind === 'initial' || p.kind === 'final'
        ? 40 : 80)())
      .attr('transform', `translate(${sx(p.x)},${sy(p.y)})`).attr('fill', p.kind === 'contact' ? t.page : t.ink).attr('stroke', t.ink)
          .attr('stroke-width', 1.5)
      .append('title').text(p.label);
    const half = 3.4 * p.label.length, middle = Math.min(Math.max(sx(p.x), margin.left + half), width - margin.right - half);
    const places = [-11, 20].map((dy) => ({lo: middle - half, hi: middle + half, y: sy(p.y) + dy}));
    const free = places.find((b) => b.y > margin.top + 8 && b.y < height - margin.bottom && !taken.some((c) => b.lo < c.hi && b.hi > c.lo
        && Math.abs(b.y - c.y) < 13));
    if (!free || marks.length > 40) continue;
    taken.push(free);
    inside.append('text').attr('x', middle).attr('y', free.y).attr('text-anchor', 'middle').attr('fill', t.quiet).attr('font-size', 11)
      .attr('paint-order', 'stroke').attr('stroke', t.page).attr('stroke-width', 3).text(p.label);
  }
  legend(root, t, lines, new Set(marks.map((p) => p.kind)), width - margin.right);
  const here = all.find((p) => p.row === row);
  if (here)
    inside.append('circle').attr('class', 'here').attr('cx', sx(here.x)).attr('cy', sy(here.y)).attr('r', 7).attr('fill', t.index[0])
        .attr('fill-opacity', 0.35)
      .attr('stroke', t.index[0]).attr('stroke-width', 2);
  return {sx, sy, all};
}

function legend(root, t, lines, kinds, right) {
  const entries = [];
  if (lines.some((l) => l.stable)) entries.push({text: lines.some((l) => !l.stable) ? 'stable' : '', line: [t.ink, 3, null]});
  for (const n of [...new Set(lines.filter((l) => !l.stable).map((l) => l.negative))].sort((a, b) => a - b))
    entries.push({text: `unstable, index ${n}`, line: [indexColour(t, n), 1.8, '6 4']});
  for (const kind of ['branch', 'limit', 'contact', 'jump', 'event']) if (kinds.has(kind)) entries.push({text: kindNames[kind], kind});
  const shown = entries.filter((e) => e.text), sizes = shown.map((e) => 26 + 6.3 * e.text.length);
  let at = right - d3.sum(sizes), y = 30;
  if (at < 60) at = 60;
  shown.forEach((e, k) => {
    if (at + sizes[k] > right + 4) { at = 60; y += 14; }
    if (e.line) root.append('line').attr('x1', at).attr('x2', at + 18).attr('y1', y - 4).attr('y2', y - 4).attr('stroke', e.line[0])
        .attr('stroke-width', e.line[1]).attr('stroke-dasharray', e.line[2]);
    else root.append('path').attr('d', d3.symbol().type(symbols[e.kind]).size(60)()).attr('transform', `translate(${at + 10},${y - 4})`)
        .attr('fill', e.kind === 'contact' ? t.page : t.ink).attr('stroke', t.ink);
    root.append('text').attr('x', at + 22).attr('y', y).attr('fill', t.quiet).attr('font-size', 11).text(e.text);
    at += sizes[k];
  });
}

/// The diagram on the page: zoom, the row under the pointer, the row that is chosen.
class Diagram {
  constructor(svg, tip, choose) {
    Object.assign(this, {svg, tip, choose, view: d3.zoomIdentity, row: 0, others: []});
    const wheel = () => d3.event.ctrlKey || document.activeElement === svg;
    this.zoom = d3.zoom().scaleExtent([1, 1e4]).filter(() => (d3.event.type === 'wheel' ? wheel() : d3.event.type !== 'dblclick'
        && !this.near(d3.event, 40)))
      .on('zoom', () => { this.view = d3.event.transform; this.draw(); });
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
    this.tip.replaceChildren(element('b', p.label || `point ${p.row}`));
    for (const c of this.run.path.columns)
      if (c !== 'label' && this.run.path.at(c, p.row) !== null && this.run.path.at(c, p.row) !== '') this.tip
          .append(element('i', c), element('span', short(this.run.path.at(c, p.row))));
    const {width} = this.size(), left = this.scales.sx(p.x);
    this.tip.style.top = '8px';
    this.tip.style.left = left < width / 2 ? `${left + 24}px` : '';
    this.tip.style.right = left < width / 2 ? '' : `${width - left + 24}px`;
  }

  /// The figure as a file of its own, dark on light.
  svgText() {
    const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg'), {width, height} = this.size(), t = theme(false);
    drawDiagram(svg, {...this, row: -1, width, height, t});
    d3.select(svg).attr('width', width).attr('height', height).insert('rect', ':first-child').attr('width', width).attr('height', height)
        .attr('fill', t.page);
    d3.select(svg).insert('title', ':first-child').text(`${this.run.title}: ${this.y} against ${this.x}`);
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
