'use strict';
// The page: one run at a time, one row of its path at a time, and everything that shows it.

const $ = (id) => document.getElementById(id);
const runs = report.runs.map((data, k) => new Run(data, k));
const sweep = report.sweep ? new Table(report.sweep) : null;
const page = {run: null, row: 0, mode: null, timer: 0};

const diagram = new Diagram($('diagram'), $('tip'), (row) => select(row));
let shape = null;
try {
  shape = new ShapeView($('shape'));
} catch (error) {
  page.noDrawing = `This browser cannot draw in three dimensions (${error.message}).`;
}

/// What a diagram begins with: of a path the first observable that changes, against the load factor.
function firstColumns(run) {
  const observables = run.path.numeric(), after = run.path.columns.indexOf(run.in_time ? 'balance' : 'stable');
  const own = observables.filter((c) => run.path.columns.indexOf(c) > after && !['negative_rigid', 'parent'].includes(c)
      && !c.startsWith('eigenvalue_') && new Set(run.path.column(c)).size > 1);
  return [run.path.has(run.parameter) ? run.parameter : observables[0], own[0] || 'energy'];
}

function open(number) {
  stop();
  const run = page.run = runs[number];
  if (runs.length > 1) $('run').value = number;
  document.title = `${run.title || run.name} – elamin`;
  $('title').textContent = run.title || run.name;
  const good = run.status === 'done';
  $('status').textContent = {done: 'done', not_converged: 'not converged', interrupted: 'interrupted'}[run.status] || run.status;
  $('status').className = good ? 'badge' : 'badge bad';
  $('message').textContent = run.message;
  $('warnings').textContent = run.warnings.map((w) => `Warning: ${w}.`).join(' ');
  const columns = run.path.numeric().map((c) => [c, c === 'lambda' ? 'load factor' : c]), [x, y] = firstColumns(run);
  const keep = (id, usual) => (columns.some(([c]) => c === $(id).value) ? $(id).value : usual);
  const [across, upwards] = [keep('x', x), keep('y', y)];
  fill($('x'), columns, across), fill($('y'), columns, upwards);
  page.row = Math.max(0, run.path.rows - 1);
  $('row').max = page.row;
  $('transport').hidden = run.path.rows < 2;
  $('diagram-part').hidden = run.path.rows < 2;
  $('views').classList.toggle('single', run.path.rows < 2);
  $('size').parentElement.hidden = !run.shape || !run.shape.radius.length;
  $('colour').parentElement.hidden = !run.shape || !run.shape.fields.length;
  if (run.states.length) fill($('ghost'), [['', 'nothing'], ...run.states.map((s, k) => [k, nameOf(run, s)])], '');
  fill($('colour'), [['', 'structure'], ...(run.shape ? run.shape.fields.map((f) => [f.key, f.name]) : [])], run.shape
      && run.shape.structures.length === 1 && run.shape.bonds.length ? run.shape.fields[0].key : '');
  $('shape-part').hidden = !run.states.length && !run.no_shape;
  if (shape && run.states.length) shape.open(run);
  showDiagram(), showEvents(), showAbout(), select(page.row);
  for (const b of $('multiples').children) b.setAttribute('aria-pressed', b.dataset.run === `${number}`);
  showSweep();
}

const nameOf = (run, s) => s.label || (run.in_time ? `time ${short(run.path.at('time', s.row))}` : `point ${s.row}`);
const others = () => ($('overlay').checked ? runs.filter((r) => r !== page.run) : []);
const showDiagram = () => diagram.show(page.run, $('x').value, $('y').value, others());

/// Everything goes to this row of the path.
function select(row) {
  const run = page.run, p = run.path;
  page.row = row;
  $('row').value = row;
  const label = p.at('label', row), unstable = p.at('negative', row);
  const parts = [`point ${row}`, label, `${run.in_time ? 'time' : 'load factor'} ${short(p.at(run.parameter, row))}`, p.has('stable')
      ? (p.at('stable', row) ? 'stable' : ['branch', 'limit'].includes(kindOf(label)) ? 'critical' : `unstable, index ${unstable}`) : ''];
  $('where').textContent = p.rows ? parts.filter((t) => t).join(' · ') : '';
  $('row').setAttribute('aria-valuetext', $('where').textContent);
  diagram.select(row);
  for (const id of ['energy', 'eigenvalues', 'iterations', 'contacts']) moveCursor($(id), run, row, +$(id).dataset.left || undefined);
  for (const tr of $('events').querySelectorAll('tr')) tr.classList.toggle('here', tr.dataset.row === `${row}`);
  const state = run.nearest(row);
  if (state !== page.state || run !== page.shownRun) {
    page.state = state, page.shownRun = run;
    const modes = state ? arrays(state).modes : [];
    fill($('mode'), modes.map((m, k) => [k, m.name]));
    $('mode-tools').hidden = !modes.length;
    $('swing').checked = false, $('amplitude').value = 0, page.swung = undefined;
  }
  showShape();
}

function showShape() {
  const run = page.run, state = page.state;
  const told = [];
  if (run.no_shape) told.push(`There is no shape to show: ${run.no_shape}`);
  else if (page.noDrawing) told.push(page.noDrawing);
  else if (state) {
    const there = state.row === page.row;
    told.push(`Shape: ${nameOf(run, state)}${there ? '' : `, the nearest of ${run.states.length} stored states`}.`);
    if (run.states.length < run.stored) told.push(`Of ${run.stored} stored states ${run.states.length} are in this page.`);
    if (there && arrays(state).contacts.length) told.push(`${plural(arrays(state).contacts.length, 'contact')}.`);
    told.push('Drag to turn it; after a click the wheel comes nearer.');
  }
  $('shape-note').textContent = told.join(' ');
  if (!shape || !state) return;
  const modes = arrays(state).modes, mode = modes[$('mode').value] || null, field = $('colour').value;
  shape.show(state, {ghost: $('ghost').value === '' ? null : run.states[$('ghost').value], mode, amplitude: mode
      ? page.swung ?? $('amplitude').value / 100 : 0, field, size: $('size').value / 100});
  $('shape').setAttribute('aria-label',
      `${run.title || run.name}, ${nameOf(run, state)}: ${run.shape.radius.length} particles, ${run.shape.bodies.length} bodies, ${arrays(state).contacts.length} contacts`);
  showLegend(field);
}

function showLegend(field) {
  const run = page.run, t = theme(), rows = [];
  const line = (mark, text) => { const d = element('div'); d.append(mark, element('span', text)); rows.push(d); };
  const swatch = (colour) => { const m = element('span'); m.className = 'swatch'; m.style.background = colour; return m; };
  const f = run.shape.fields.find((g) => g.key === field);
  if (f) {
    const ramp = element('span'), most = short(+(shape.reach[field] || 0).toPrecision(2)), from = shape.signed[field] ? 0 : 0.5;
    ramp.className = 'ramp';
    ramp.style.background = `linear-gradient(90deg, ${d3.range(from, 1.01, 0.1).map((v) => d3.interpolateRdBu(1 - v)).join(',')})`;
    line(ramp, `${f.name}, ${from ? '0' : `−${most}`} to ${most}`);
  } else if (run.shape.structures.length > 1 && run.shape.structures.length < 9)
    run.shape.structures.forEach((s, k) => line(swatch(seriesColour(t, k)), s.name));
  if (arrays(page.state).contacts.length && shape.most > 0) line(swatch(t.index[0]),
      `contact forces, at most ${short(+shape.most.toPrecision(3))}`);
  if (page.state.loads.some((v) => v)) line(swatch(t.series[2]), 'loads');
  if (shape.mounts.some((m) => m.visible)) line(swatch(t.quiet), 'held: bars, directions; rings, turns');
  if (shape.enlarged) line(element('span'), 'particles are drawn larger than they are');
  $('legend').replaceChildren(...rows);
}

const sentences = {branch: 'a branch point', limit: 'a limit point: the load factor turns back', jump: 'it snaps to another equilibrium',
    initial: 'the start', final: 'the end'};

function showEvents() {
  const run = page.run, labels = run.path.column('label'), drops = new Map(snaps(run).map((f) => [f.label, f.freed]));
  const rows = d3.range(run.path.rows).filter((k) => labels[k]);
  $('events-part').hidden = !rows.length;
  const head = element('tr'), body = [];
  for (const h of ['event', run.in_time ? 'time' : 'load factor', 'energy', 'what']) head
      .append(element('th', h, ['event', 'what'].includes(h) ? {} : {class: 'number'}));
  for (const k of rows) {
    const tr = element('tr', null, {'data-row': k}), button = element('button', labels[k]), cell = element('td');
    const event = run.events.column('label').indexOf(labels[k]), kind = kindOf(labels[k]), freed = drops.get(labels[k]);
    const what = (event >= 0 && run.events.at('what', event)) || '', before = run.events.at('negative_before', event),
        after = run.events.at('negative_after', event);
    button.onclick = () => select(k);
    cell.append(button);
    const named = kind === 'event' ? (event >= 0 ? 'the observable reaches its value' : 'the stage ends') : '';
    const text = [kind === 'jump' ? sentences.jump : what || sentences[kind] || named, before === 0 && after > 0 ? 'stability is lost'
        : before > 0 && after === 0 ? 'stability is won back' : '', freed !== undefined ? `${short(freed)} of energy is set free` : '',
      event >= 0 && before !== after && before >= 0 ? `Morse index ${before} → ${after}` : ''].filter((s) => s).join('; ');
    tr.append(cell, element('td', short(run.path.at(run.parameter, k)), {class: 'number'}), element('td', short(run.path.at('energy', k)),
        {class: 'number'}), element('td', text));
    body.push(tr);
  }
  $('events').replaceChildren(head, ...body);
  $('freed').textContent = drops.size > 1 ? `Together the ${drops.size} snaps set ${short(d3.sum([...drops.values()]))} of energy free.`
      : '';
}

function drawCharts() {
  const run = page.run, all = {energy: drawEnergies, contacts: drawContacts, eigenvalues: drawEigenvalues, iterations: drawIterations};
  const drawn = () => Object.entries(all).map(([id, draw]) => [id, draw($(id), run, page.row, select)]);
  for (const [id, there] of drawn()) $(`${id}-part`).hidden = !there;
  drawn();                                                     // once more, as wide as they are now
}

function showAbout() {
  const run = page.run, facts = [], fact = (name, value, code) => { if (value) { const d = element('dd'); d
      .append(code ? element('code', value) : value); facts.push(element('dt', name), d); } };
  const met = run.expected.filter((e) => e.met).length;
  $('met').hidden = !run.expected.length;
  $('met').textContent = run.expected.length ? `${met} of ${run.expected.length} expectations of the problem file are met.` : '';
  $('met').className = met === run.expected.length ? 'good' : 'bad';
  const head = element('tr');
  for (const h of ['expected', 'at', 'value', 'reached', '', 'source']) head.append(element('th', h));
  $('expected-part').hidden = !run.expected.length;
  $('expected-part').open = met < run.expected.length;
  $('expected-count').textContent = `The ${plural(run.expected.length, 'expectation')} of the problem file, ${met} met`;
  $('expected').replaceChildren(head, ...run.expected.map((e) => {
    const tr = element('tr');
    tr.append(element('td', e.column), element('td', e.at), element('td', short(e.expected)), element('td', short(e.value)),
        element('td', e.met ? '✓ met' : '✗ not met', {class: e.met ? 'good' : 'bad'}), element('td', e.source));
    return tr;
  }));
  fact('problem file', run.input.file), fact('its SHA-256', run.input.sha256, true);
  fact('elamin', run.version), fact('directory', run.directory);
  fact('tolerances', Object.entries(run.tolerances).map(([k, v]) => `${k} ${short(v)}`).join(', '));
  fact('seconds', Object.entries(run.times).map(([k, v]) => `${k} ${+v.toPrecision(3)}`).join(', '));
  fact('free at the end', run.zero_modes.join(', '));
  fact('the run again', `elamin ${quoted(`${run.directory}/resolved.toml`)} -o again`, true), fact('this page again', report.command, true);
  $('facts').replaceChildren(...facts);
  $('described').textContent = run.described || run.no_shape;
  $('input-title').textContent = run.input.text !== null ? `The problem file, ${run.input.file}`
      : `The problem file ${run.input.file} is not there any more, or is not what was run`;
  $('input').textContent = run.input.text ?? '';
  $('resolved').textContent = run.resolved;
  drawCharts();
}
const quoted = (text) => (/^[\w./=+,-]+$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`);

function showSweep() {
  if (!sweep) return;
  drawSweep($('sweep-plot'), sweep, $('sweep-x').value, $('sweep-y').value, {logX: $('sweep-log-x').checked,
      logY: $('sweep-log-y').checked, chosen: page.run.number, choose: (k) => runs[k] && open(k)});
}

function stop() {
  cancelAnimationFrame(page.timer);
  page.timer = 0;
  $('play').textContent = '▶ Play';
  $('play').setAttribute('aria-pressed', 'false');
}
function play() {
  if (page.timer) return stop();
  const rows = page.run.path.rows, seconds = Math.min(12, Math.max(3, rows / 10)), from = page.row >= rows - 1 ? 0 : page.row,
      began = performance.now();
  $('play').textContent = '❚❚ Pause';
  $('play').setAttribute('aria-pressed', 'true');
  const step = (now) => {
    const row = Math.min(rows - 1, from + Math.floor((now - began) / 1000 / seconds * rows));
    if (row !== page.row) select(Math.max(row, 0));
    if (row >= rows - 1) return stop();
    page.timer = requestAnimationFrame(step);
  };
  page.timer = requestAnimationFrame(step);
}
function swing(now) {
  if (!$('swing').checked) { page.swung = undefined; return showShape(); }
  page.swung = (+$('amplitude').value || 50) / 100 * Math.sin(now / 400);
  showShape();
  requestAnimationFrame(swing);
}

$('play').onclick = play;
$('row').oninput = () => { stop(); select(+$('row').value); };
$('diagram').onkeydown = (e) => {
  const step = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10, PageDown: -10}[e.key];
  if (step) { e.preventDefault(); select(Math.max(0, Math.min(page.run.path.rows - 1, page.row + step))); }
  if (e.key === '+' || e.key === '-') diagram.by(e.key === '+' ? 1.5 : 1 / 1.5);
};
$('shape').onkeydown = (e) => { if (/^Arrow|^[+-]$/.test(e.key)) { e.preventDefault(); shape.key(e.key); } };
for (const id of ['x', 'y', 'overlay']) $(id).onchange = showDiagram;
for (const id of ['colour', 'ghost', 'mode']) $(id).onchange = showShape;
$('size').oninput = $('amplitude').oninput = showShape;
$('swing').onchange = () => requestAnimationFrame(swing);
$('zoom-in').onclick = () => diagram.by(1.6);
$('zoom-out').onclick = () => diagram.by(1 / 1.6);
$('zoom-fit').onclick = () => diagram.fit();
const fileName = (extension) => `${page.run.name.replace(/[^\w.=+-]/g, '_')}${extension}`;
$('save-svg').onclick = () => save(fileName('.svg'), diagram.svgText(), 'image/svg+xml');
$('save-csv').onclick = () => save(fileName('.csv'), diagram.csvText(), 'text/csv');
$('save-png').onclick = () => $('shape').toBlob((blob) => save(fileName('.png'), blob, 'image/png'));
for (const b of document.querySelectorAll('[data-view]')) b.onclick = () => shape && shape.look(b.dataset.view);
for (const id of ['sweep-x', 'sweep-y', 'sweep-log-x', 'sweep-log-y']) $(id).onchange = showSweep;
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => open(page.run.number));
new ResizeObserver(() => { if (page.run) drawCharts(), showSweep(); }).observe($('charts'));

$('made').textContent = `Made by elamin ${report.version}. ${report.note}`;
$('all-runs').hidden = $('choice').hidden = runs.length < 2;
fill($('run'), runs.map((r, k) => [k, r.name]));
$('run').onchange = () => open(+$('run').value);
if (sweep) {
  $('sweep').hidden = false;
  const columns = sweep.numeric().map((c) => [c, c]), swept = sweep.columns.slice(0, sweep.columns.indexOf('status'))
      .filter((c) => columns.some(([n]) => n === c));
  const thresholds = ['branch:1', 'limit:1', 'contact:1'].filter((c) => sweep.column(c).some((v) => v !== null));
  fill($('sweep-x'), columns, swept.find((c) => !c.startsWith('expect.')) || swept[0]), fill($('sweep-y'), columns, thresholds[0]
      || firstColumns(runs[0])[1]);
}
if (runs.length > 1) {
  $('overlay').checked = runs.length <= 12;
  if (!sweep) $('sweep').hidden = false, $('sweep-title').textContent = 'The runs', $('sweep-plot').remove(),
      $('sweep').querySelector('.tools').remove();
  $('multiples').append(...runs.map((run, k) => {
    const b = element('button', null, {'data-run': k, title: run.name}), svg = document.createElementNS('http://www.w3.org/2000/svg',
        'svg'), [x, y] = firstColumns(run), all = points(run, x, y), t = theme();
    const sx = d3.scaleLinear(d3.extent(all, (p) => p.x), [4, 116]), sy = d3.scaleLinear(d3.extent(all, (p) => p.y), [56, 4]);
    d3.select(svg).attr('viewBox', '0 0 120 60').attr('aria-hidden', 'true');
    for (const l of pieces(all).lines)
      d3.select(svg).append('path').attr('d', d3.line().x((p) => sx(p.x)).y((p) => sy(p.y))(l.points)).attr('fill', 'none')
          .attr('stroke', l.stable ? t.series[0] : indexColour(t, l.negative)).attr('stroke-width', 1.5);
    b.append(svg, element('span', run.name));
    b.onclick = () => open(k);
    return b;
  }));
}
open(0);
