'use strict';
// Small charts along the path, point by point: energies, contacts, eigenvalues, iterations; and the results of a sweep.

/// An empty chart over the rows of a run: scales, the area to draw in, the line at the chosen row.
function frame(svg, run, row, choose, [lo, hi], left = 64) {
  const {t, root, width, height} = blank(svg, 420, 220), rows = run.path.rows, bottom = height - 34;
  const sx = d3.scaleLinear([0, Math.max(1, rows - 1)], [left, width - 16]), sy = d3.scaleLinear([lo, hi], [bottom, 20]);
  axis(root, t, d3.axisBottom(sx).tickFormat(d3.format('d')), [0, bottom], Math.min(rows, width / 80));
  if (hi > lo) axis(root, t, d3.axisLeft(sy).tickFormat(ticks(sy)), [left, 0], 4);
  words(root, width - 16, height - 4, 'point of the path', t.quiet, atEnd);
  const area = root.append('g');
  put(root, 'line', {class: 'cursor', x1: sx(row), x2: sx(row), y1: 18, y2: bottom, stroke: t.index[0], 'stroke-width': 1.5});
  root.on('click', () => choose(Math.max(0, Math.min(rows - 1, Math.round(sx.invert(d3.mouse(svg)[0]))))));
  return {t, area, sx, sy, root, width, height, left};
}
const moveCursor = (svg, run, row, left = 64) => {
  const at = d3.scaleLinear([0, Math.max(1, run.path.rows - 1)], [left, (svg.clientWidth || 420) - 16])(row);
  d3.select(svg).select('.cursor').attr('x1', at).attr('x2', at);
};

function key({root, t, left}, names) {
  let at = left + 6;
  names.forEach((name, k) => {
    put(root, 'rect', {x: at, y: 4, width: 10, height: 10, fill: seriesColour(t, k)});
    words(root, at + 14, 13, name, t.quiet, small);
    at += 26 + 6.4 * name.length;
  });
}

/// The energy that each snap set free: from what the program tells of it.
function snaps(run) {
  const e = run.events, what = e.column('what'), all = [];
  for (let k = 0; k < e.rows; ++k) {
    const m = /from energy (\S+) to (\S+)/.exec(what[k] || '');
    if (m) all.push({label: e.at('label', k), row: run.path.column('label').indexOf(e.at('label', k)), freed: m[1] - m[2]});
  }
  return all;
}

const energyTerms = ['bond', 'angle', 'contact', 'wall', 'cohesion', 'body', 'external', 'kinetic', 'dissipation'];

function drawEnergies(svg, run, row, choose) {
  const p = run.path, names = energyTerms.filter((c) => p.has(c) && p.column(c).some((v) => v));
  if (!names.length || p.rows < 2) return false;
  const rows = d3.range(p.rows).map((k) => Object.fromEntries(names.map((c) => [c, +p.at(c, k) || 0])));
  const layers = d3.stack().keys(names).offset(d3.stackOffsetDiverging)(rows);
  const lowest = d3.min(layers, (l) => d3.min(l, (v) => v[0])), highest = d3.max(layers, (l) => d3.max(l, (v) => v[1]));
  const chart = frame(svg, run, row, choose, [lowest, highest]), {t, area, sx, sy} = chart;
  const band = d3.area().x((_, k) => sx(k)).y0((v) => sy(v[0])).y1((v) => sy(v[1]));
  layers.forEach((l, k) => put(area, 'path', {d: band(l), fill: seriesColour(t, k), 'fill-opacity': 0.75}));
  for (const f of snaps(run).filter((g) => g.row >= 0)) {
    const x = sx(f.row);
    put(area, 'line', {x1: x, x2: x, y1: 20, y2: chart.height - 34, stroke: t.ink, 'stroke-dasharray': '2 3'});
    words(area, x - 4, 30, `−${short(+f.freed.toPrecision(3))}`, t.ink, {...atEnd, ...small, ...haloed(t)});
  }
  key(chart, names);
  return true;
}

/// The trees of a landscape, side by side, one for each load factor.
function drawLandscape(svg, run) {
  const all = (run.landscape && run.landscape.landscapes || []).filter((l) => l.tree.leaves.length);
  if (!all.length) return false;
  const {t, root, width, height} = blank(svg, 420, 260), each = width / all.length;
  all.forEach(({load_factor, minima, saddles, tree}, k) => {
    const [lo, hi] = d3.extent([...tree.leaves.map((l) => l.energy), ...tree.lines.flat().map((p) => p[1])]);
    const left = k * each + 60, sx = d3.scaleLinear([0.5, tree.leaves.length + 0.5], [left, (k + 1) * each - 8]);
    const sy = d3.scaleLinear(hi > lo ? [lo, hi] : [lo - 1, lo + 1], [height - 40, 30]);
    axis(root, t, d3.axisLeft(sy).tickFormat(ticks(sy)), [left, 0], 4);
    for (const line of tree.lines)
      put(root, 'path', {d: d3.line().x((p) => sx(p[0])).y((p) => sy(p[1]))(line), fill: 'none', stroke: seriesColour(t, 0), 'stroke-width': 2});
    for (const l of tree.leaves) {
      put(root, 'circle', {cx: sx(l.x), cy: sy(l.energy), r: 4, fill: seriesColour(t, 0)}).append('title').text(`${l.label}, energy ${short(l.energy)}`);
      if ((sx(1) - sx(0)) > 60) words(root, sx(l.x), sy(l.energy) + 16, l.label, t.quiet, {'text-anchor': 'middle', ...small});
    }
    const counted = each > 260 ? `: minima ${minima}, saddles ${saddles}` : '';
    words(root, left + 4, 18, `load factor ${short(load_factor)}${counted}`, t.quiet, small);
  });
  return true;
}

/// Who touches whom at the stored states; of many pairs, how many of which structures.
function drawContacts(svg, run, row, choose) {
  const states = run.states.filter((s) => s.row >= 0), pairs = new Map(), walls = run.shape ? run.shape.walls : [];
  const name = (id) => (id < 0 ? walls[-id - 1].name : run.called(id));
  const collect = (called) => {
    pairs.clear();
    for (const s of states)
      for (const c of arrays(s).contacts) {
        const pair = `${called(c.first)} – ${called(c.second)}`;
        if (!pairs.has(pair)) pairs.set(pair, new Map());
        const at = pairs.get(pair).get(s.row) || {state: s, count: 0, force: 0};
        ++at.count, at.force += c.size;
        pairs.get(pair).set(s.row, at);
      }
  };
  collect(name);
  if (pairs.size > 16) collect((id) => name(id).replace(/ \d+$/, ''));
  const counted = run.path.has('contacts') ? run.path.column('contacts').map((v) => +v || 0) : [];
  if (!pairs.size && !counted.some((v) => v)) return false;
  const shown = [...pairs].slice(0, 16), space = 17, longest = d3.max(shown, ([pair]) => pair.length) || 0;
  const left = Math.min(190, Math.max(counted.some((v) => v) ? 118 : 64, 14 + 6.3 * longest));
  if (run.path.rows < 2) return drawForces(svg, shown.map(([pair, at]) => [pair, [...at.values()][0]]), left, space);
  svg.style.height = `${Math.max(220, 120 + space * shown.length)}px`;
  svg.dataset.left = left;
  const {t, area, sx, width, height} = frame(svg, run, row, choose, [0, 0], left);
  const most = d3.max(shown, ([, at]) => d3.max([...at.values()], (c) => c.force)) || 1;
  shown.forEach(([pair, at], k) => {
    const y = 32 + space * k, hits = [...at.values()].sort((a, b) => a.state.row - b.state.row);
    const stroke = (x1, x2, more) => put(area, 'line', {x1, x2, y1: y, y2: y, ...more});
    words(area, left - 8, y + 4, pair.length > 28 ? `${pair.slice(0, 27)}…` : pair, t.ink, {...atEnd, ...small});
    stroke(left, width - 16, {stroke: t.rule});
    for (let i = 1; i < hits.length; ++i)
      if (states.indexOf(hits[i].state) === states.indexOf(hits[i - 1].state) + 1)
        stroke(sx(hits[i - 1].state.row), sx(hits[i].state.row), {stroke: t.series[0], 'stroke-width': 4});
    for (const {state, count, force} of hits) {
      const told = `${count > 1 ? `${count} contacts, ` : ''}force ${short(force)}`;
      put(area, 'circle', {cx: sx(state.row), cy: y, r: 3 + 5 * Math.sqrt(force / most), fill: t.series[0], 'fill-opacity': 0.8})
        .append('title').text(`${pair} at ${state.label || `point ${state.row}`}: ${told}`);
    }
  });
  if (counted.some((v) => v)) {
    const top = 44 + space * shown.length, sy = d3.scaleLinear([0, d3.max(counted)], [height - 36, top]);
    const steps = d3.area().curve(d3.curveStepAfter).x((_, k) => sx(k)).y0(sy(0)).y1((v) => sy(v));
    put(area, 'path', {d: steps(counted), fill: t.series[2], 'fill-opacity': 0.5});
    words(area, left - 8, (height - 36 + top) / 2, `contacts, up to ${d3.max(counted)}`, t.quiet, {...atEnd, ...small});
  }
  return true;
}

/// Of a single equilibrium the forces between pairs, as bars.
function drawForces(svg, shown, left, space) {
  svg.style.height = `${20 + space * shown.length}px`;
  const {t, root, width} = blank(svg, 420, 220);
  const sx = d3.scaleLinear([0, d3.max(shown, ([, at]) => at.force) || 1], [left, Math.max(left + 20, width - 220)]);
  shown.forEach(([pair, {force, count}], k) => {
    const y = 8 + space * k;
    words(root, left - 8, y + 10, pair, t.ink, {...atEnd, ...small});
    put(root, 'rect', {x: left, y, width: Math.max(1, sx(force) - left), height: space - 5, fill: t.series[0]});
    words(root, sx(force) + 6, y + 10, `force ${short(force)}${count > 1 ? `, ${count} contacts` : ''}`, t.quiet, small);
  });
  return true;
}

/// A threshold as a curve: its load factor against the second parameter, with what happens on it.
function drawCurve(svg, run) {
  const c = run.curve;
  if (!c || c.rows < 2) return false;
  const {t, root, width, height} = blank(svg, 420, 220), x = c.column('second').map(asNumber), y = c.column('lambda').map(asNumber);
  const sx = d3.scaleLinear(reach(x), [64, width - 16]).nice(), sy = d3.scaleLinear(reach(y), [height - 34, 26]).nice();
  axis(root, t, d3.axisBottom(sx).tickFormat(ticks(sx)), [0, height - 34], width / 90);
  axis(root, t, d3.axisLeft(sy).tickFormat(ticks(sy)), [64, 0], 4);
  words(root, width - 16, height - 4, c.second, t.ink, atEnd);
  words(root, 6, 14, `load factor of ${c.of}`, t.ink);
  put(root, 'path', {d: d3.line().x((v) => sx(v)).y((_, k) => sy(y[k]))(x), fill: 'none', stroke: t.series[0], 'stroke-width': 2});
  x.forEach((v, k) => {
    const label = c.at('label', k);
    if (!label || label === 'start' || label === 'end') return;
    put(root, 'circle', {cx: sx(v), cy: sy(y[k]), r: 4.5, fill: t.index[0]})
      .append('title').text(`${label}: ${c.second} ${short(v)}, load factor ${short(y[k])}; ${c.at('what', k)}`);
    words(root, sx(v) + 7, sy(y[k]) - 6, label, t.ink, {...small, ...haloed(t)});
  });
  return true;
}

function drawEigenvalues(svg, run, row, choose) {
  const names = run.path.columns.filter((c) => /^eigenvalue_\d+$/.test(c)), values = names.map((c) => run.path.column(c));
  if (!names.length || run.path.rows < 2) return false;
  const [lo, hi] = d3.extent(values.flat().filter((v) => v !== null));
  const chart = frame(svg, run, row, choose, [Math.min(lo, 0), Math.max(hi, 0)]), {t, area, sx, sy, left, width} = chart;
  put(area, 'line', {x1: left, x2: width - 16, y1: sy(0), y2: sy(0), stroke: t.ink});
  const line = d3.line().defined((v) => v !== null).x((_, k) => sx(k)).y((v) => sy(v));
  values.forEach((v, k) => put(area, 'path', {d: line(v), fill: 'none', stroke: seriesColour(t, k), 'stroke-width': 2}));
  key(chart, names.map((_, k) => `${k + 1}`));
  return true;
}

function drawIterations(svg, run, row, choose) {
  const counts = run.path.column('iterations').map((v) => +v || 0);
  if (counts.length < 2) return false;
  const {t, area, sx, sy} = frame(svg, run, row, choose, [0, d3.max(counts) || 1]), wide = Math.max(1, Math.min(12, sx(1) - sx(0) - 1));
  counts.forEach((v, k) => put(area, 'rect', {x: sx(k) - wide / 2, width: wide, y: sy(v), height: sy(0) - sy(v), fill: t.series[0]}));
  return true;
}

/// One result of every run of a sweep against one column of sweep.csv.
function drawSweep(svg, table, x, y, {logX, logY, chosen, choose}) {
  const {t, root, width, height} = blank(svg, 500, 300);
  const at = (column, k) => asNumber(table.at(column, k));
  const dots = d3.range(table.rows).map((k) => ({k, x: at(x, k), y: at(y, k), status: at('status', k)})).filter(
    (p) => Number.isFinite(p.x) && Number.isFinite(p.y) && !(logX && p.x <= 0) && !(logY && p.y <= 0));
  const scale = (log, get, range) => (log ? d3.scaleLog() : d3.scaleLinear()).domain(reach(dots.map(get))).range(range).nice();
  const sx = scale(logX, (p) => p.x, [72, width - 14]), sy = scale(logY, (p) => p.y, [height - 40, 26]);
  axis(root, t, d3.axisBottom(sx).tickFormat(logX ? undefined : ticks(sx)), [0, height - 40], width / 90);
  axis(root, t, d3.axisLeft(sy).tickFormat(logY ? undefined : ticks(sy)), [72, 0], 6);
  words(root, width - 14, height - 6, x, t.ink, atEnd);
  words(root, 6, 14, inWords(y), t.ink);
  if (new Set(dots.map((p) => p.x)).size === dots.length) {
    const curve = d3.line().x((p) => sx(p.x)).y((p) => sy(p.y))([...dots].sort((a, b) => a.x - b.x));
    put(root, 'path', {d: curve, fill: 'none', stroke: t.series[0], 'stroke-opacity': 0.5});
  }
  for (const p of dots) {
    const here = p.k === chosen, fill = p.status === 'done' ? t.series[0] : t.index[0];
    put(root, 'circle', {cx: sx(p.x), cy: sy(p.y), r: here ? 7 : 4.5, fill, stroke: here ? t.ink : 'none', 'stroke-width': 2})
      .style('cursor', 'pointer').on('click', () => choose(p.k))
      .append('title').text(`run ${p.k + 1}: ${x} ${short(p.x)}, ${y} ${short(p.y)}, ${p.status}`);
  }
}
