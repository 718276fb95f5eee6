'use strict';
// Small charts along the path, point by point: energies, contacts, eigenvalues, iterations; and the results of a sweep.

/// An empty chart over the rows of a run: scales, the area to draw in, the line at the chosen row.
function frame(svg, run, row, choose, [lo, hi], {left = 64, label = ''} = {}) {
  const t = theme(), width = svg.clientWidth || 420, height = svg.clientHeight || 220, rows = run.path.rows;
  const root = d3.select(svg).attr('viewBox', `0 0 ${width} ${height}`);
  root.selectAll('*').remove();
  const sx = d3.scaleLinear([0, Math.max(1, rows - 1)], [left, width - 16]), sy = d3.scaleLinear([lo, hi], [height - 34, 20]);
  const paint = (g) => g.call((a) => a.selectAll('line, path').attr('stroke', t.rule)).call((a) => a.selectAll('text')
      .attr('fill', t.quiet));
  root.append('g').attr('transform', `translate(0,${height - 34})`).call(d3.axisBottom(sx).ticks(Math.min(rows, width / 80))
      .tickFormat(d3.format('d')).tickSizeOuter(0)).call(paint);
  if (hi > lo) root.append('g').attr('transform', `translate(${left},0)`)
      .call(d3.axisLeft(sy).ticks(4).tickFormat(ticks(sy)).tickSizeOuter(0)).call(paint);
  root.append('text').attr('x', width - 16).attr('y', height - 4).attr('text-anchor', 'end').attr('fill', t.quiet)
      .text('point of the path');
  root.append('text').attr('x', 6).attr('y', 12).attr('fill', t.quiet).text(label);
  const area = root.append('g');
  root.append('line').attr('class', 'cursor').attr('x1', sx(row)).attr('x2', sx(row)).attr('y1', 18).attr('y2', height - 34)
      .attr('stroke', t.index[0]).attr('stroke-width', 1.5);
  root.on('click', () => choose(Math.max(0, Math.min(rows - 1, Math.round(sx.invert(d3.mouse(svg)[0]))))));
  return {t, area, sx, sy, root, width, height, left};
}
const moveCursor = (svg, run, row, left = 64) => d3.select(svg).select('.cursor').call((c) => {
  const at = d3.scaleLinear([0, Math.max(1, run.path.rows - 1)], [left, (svg.clientWidth || 420) - 16])(row);
  c.attr('x1', at).attr('x2', at);
});

function key(chart, names, colours) {
  let at = chart.left + 6;
  names.forEach((name, k) => {
    chart.root.append('rect').attr('x', at).attr('y', 4).attr('width', 10).attr('height', 10).attr('fill', colours[k]);
    chart.root.append('text').attr('x', at + 14).attr('y', 13).attr('font-size', 11).attr('fill', chart.t.quiet).text(name);
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
  const chart = frame(svg, run, row, choose, [d3.min(layers, (l) => d3.min(l, (v) => v[0])),
      d3.max(layers, (l) => d3.max(l, (v) => v[1]))]), {t, area, sx, sy} = chart;
  const colours = names.map((_, k) => seriesColour(t, k));
  const band = d3.area().x((_, k) => sx(k)).y0((v) => sy(v[0])).y1((v) => sy(v[1]));
  layers.forEach((l, k) => area.append('path').attr('d', band(l)).attr('fill', colours[k]).attr('fill-opacity', 0.75));
  const drops = snaps(run).filter((f) => f.row >= 0);
  for (const f of drops) {
    area.append('line').attr('x1', sx(f.row)).attr('x2', sx(f.row)).attr('y1', 20).attr('y2', chart.height - 34).attr('stroke', t.ink)
        .attr('stroke-dasharray', '2 3');
    area.append('text').attr('x', sx(f.row) - 4).attr('y', 30).attr('text-anchor', 'end').attr('font-size', 11).attr('fill', t.ink)
        .attr('paint-order', 'stroke').attr('stroke', t.page).attr('stroke-width', 3)
      .text(`−${short(+f.freed.toPrecision(3))}`);
  }
  key(chart, names, colours);
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
  const shown = [...pairs].slice(0, 16), space = 17, left = Math.min(190, Math.max(counted.some((v) => v) ? 118 : 64,
      14 + 6.3 * (d3.max(shown, ([pair]) => pair.length) || 0)));
  if (run.path.rows < 2) return drawForces(svg, shown.map(([pair, at]) => [pair, [...at.values()][0]]), left, space);
  svg.style.height = `${Math.max(220, 120 + space * shown.length)}px`;
  svg.dataset.left = left;
  const chart = frame(svg, run, row, choose, [0, 0], {left}), {t, area, sx, height} = chart,
      most = d3.max(shown, ([, at]) => d3.max([...at.values()], (c) => c.force)) || 1;
  area.append('g');
  shown.forEach(([pair, at], k) => {
    const y = 32 + space * k, hits = [...at.values()].sort((a, b) => a.state.row - b.state.row);
    area.append('text').attr('x', left - 8).attr('y', y + 4).attr('text-anchor', 'end').attr('font-size', 11).attr('fill', t.ink)
        .text(pair.length > 28 ? `${pair.slice(0, 27)}…` : pair);
    area.append('line').attr('x1', left).attr('x2', chart.width - 16).attr('y1', y).attr('y2', y).attr('stroke', t.rule);
    for (let i = 1; i < hits.length; ++i)
      if (states.indexOf(hits[i].state) === states.indexOf(hits[i - 1].state) + 1)
        area.append('line').attr('x1', sx(hits[i - 1].state.row)).attr('x2', sx(hits[i].state.row)).attr('y1', y).attr('y2', y)
            .attr('stroke', t.series[0]).attr('stroke-width', 4);
    for (const h of hits)
      area.append('circle').attr('cx', sx(h.state.row)).attr('cy', y).attr('r', 3 + 5 * Math.sqrt(h.force / most)).attr('fill', t.series[0])
          .attr('fill-opacity', 0.8)
        .append('title').text(`${pair} at ${h.state.label || `point ${h.state.row}`}: ${h.count > 1 ? `${h.count} contacts, ` : ''}force ${short(h.force)}`);
  });
  if (counted.some((v) => v)) {
    const top = 44 + space * shown.length, sy = d3.scaleLinear([0, d3.max(counted)], [height - 36, top]);
    area.append('path').attr('d', d3.area().curve(d3.curveStepAfter).x((_, k) => sx(k)).y0(sy(0)).y1((v) => sy(v))(counted))
        .attr('fill', t.series[2]).attr('fill-opacity', 0.5);
    area.append('text').attr('x', left - 8).attr('y', (height - 36 + top) / 2).attr('text-anchor', 'end').attr('font-size', 11)
        .attr('fill', t.quiet).text(`contacts, up to ${d3.max(counted)}`);
  }
  return true;
}

/// Of a single equilibrium the forces between pairs, as bars.
function drawForces(svg, shown, left, space) {
  const t = theme(), width = svg.clientWidth || 420, height = 20 + space * shown.length, root = d3.select(svg)
      .attr('viewBox', `0 0 ${width} ${height}`);
  svg.style.height = `${height}px`;
  root.selectAll('*').remove();
  const sx = d3.scaleLinear([0, d3.max(shown, ([, at]) => at.force) || 1], [left, Math.max(left + 20, width - 220)]);
  shown.forEach(([pair, at], k) => {
    const y = 8 + space * k;
    root.append('text').attr('x', left - 8).attr('y', y + 10).attr('text-anchor', 'end').attr('font-size', 11).attr('fill', t.ink)
        .text(pair);
    root.append('rect').attr('x', left).attr('y', y).attr('width', Math.max(1, sx(at.force) - left)).attr('height', space - 5)
        .attr('fill', t.series[0]);
    root.append('text').attr('x', sx(at.force) + 6).attr('y', y + 10).attr('font-size', 11).attr('fill', t.quiet)
        .text(`force ${short(at.force)}${at.count > 1 ? `, ${at.count} contacts` : ''}`);
  });
  return true;
}

function drawEigenvalues(svg, run, row, choose) {
  const names = run.path.columns.filter((c) => /^eigenvalue_\d+$/.test(c));
  const values = names.map((c) => run.path.column(c));
  if (!names.length || run.path.rows < 2) return false;
  const [lo, hi] = d3.extent(values.flat().filter((v) => v !== null)), chart = frame(svg, run, row, choose,
      [Math.min(lo, 0), Math.max(hi, 0)]), {t, area, sx, sy} = chart;
  area.append('line').attr('x1', chart.left).attr('x2', chart.width - 16).attr('y1', sy(0)).attr('y2', sy(0)).attr('stroke', t.ink);
  const line = d3.line().defined((v) => v !== null).x((_, k) => sx(k)).y((v) => sy(v));
  values.forEach((v, k) => area.append('path').attr('d', line(v)).attr('fill', 'none').attr('stroke', seriesColour(t, k))
      .attr('stroke-width', 2));
  key(chart, names.map((_, k) => `${k + 1}`), names.map((_, k) => seriesColour(t, k)));
  return true;
}

function drawIterations(svg, run, row, choose) {
  const counts = run.path.column('iterations').map((v) => +v || 0);
  if (counts.length < 2) return false;
  const {t, area, sx, sy} = frame(svg, run, row, choose, [0, d3.max(counts) || 1]), wide = Math.max(1, Math.min(12, sx(1) - sx(0) - 1));
  counts.forEach((v, k) => area.append('rect').attr('x', sx(k) - wide / 2).attr('width', wide).attr('y', sy(v))
      .attr('height', sy(0) - sy(v)).attr('fill', t.series[0]));
  return true;
}

/// One result of every run of a sweep against one column of sweep.csv.
function drawSweep(svg, table, x, y, {logX, logY, chosen, choose}) {
  const t = theme(), width = svg.clientWidth || 500, height = svg.clientHeight || 300, root = d3.select(svg)
      .attr('viewBox', `0 0 ${width} ${height}`);
  root.selectAll('*').remove();
  const number = (v) => (typeof v === 'boolean' ? +v : v);
  const dots = d3.range(table.rows).map((k) => ({k, x: number(table.at(x, k)), y: number(table.at(y, k)), status: table.at('status', k)}))
    .filter((p) => Number.isFinite(p.x) && Number.isFinite(p.y) && !(logX && p.x <= 0) && !(logY && p.y <= 0));
  const scale = (log, get, range) => (log ? d3.scaleLog() : d3.scaleLinear()).domain(reach(dots.map(get))).range(range).nice();
  const sx = scale(logX, (p) => p.x, [72, width - 14]), sy = scale(logY, (p) => p.y, [height - 40, 26]);
  const paint = (g) => g.call((a) => a.selectAll('line, path').attr('stroke', t.rule)).call((a) => a.selectAll('text')
      .attr('fill', t.quiet));
  root.append('g').attr('transform', `translate(0,${height - 40})`).call(d3.axisBottom(sx).ticks(width / 90)
      .tickFormat(logX ? undefined : ticks(sx)).tickSizeOuter(0)).call(paint);
  root.append('g').attr('transform', 'translate(72,0)')
      .call(d3.axisLeft(sy).ticks(6).tickFormat(logY ? undefined : ticks(sy)).tickSizeOuter(0)).call(paint);
  root.append('text').attr('x', width - 14).attr('y', height - 6).attr('text-anchor', 'end').attr('fill', t.ink).text(x);
  root.append('text').attr('x', 6).attr('y', 14).attr('fill', t.ink).text(y === 'lambda' ? 'load factor' : y);
  const inOrder = [...dots].sort((a, b) => a.x - b.x);
  if (new Set(dots.map((p) => p.x)).size === dots.length)
    root.append('path').attr('d', d3.line().x((p) => sx(p.x)).y((p) => sy(p.y))(inOrder)).attr('fill', 'none').attr('stroke', t.series[0])
        .attr('stroke-opacity', 0.5);
  for (const p of dots)
    root.append('circle').attr('cx', sx(p.x)).attr('cy', sy(p.y)).attr('r', p.k === chosen ? 7 : 4.5)
        .attr('fill', p.status === 'done' ? t.series[0] : t.index[0]).attr('stroke', p.k === chosen ? t.ink : 'none')
      .attr('stroke-width', 2).style('cursor', 'pointer').on('click', () => choose(p.k)).append('title')
          .text(`run ${p.k + 1}: ${x} ${short(p.x)}, ${y} ${short(p.y)}, ${p.status}`);
}
