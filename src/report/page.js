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
  const own = observables.filter((c) => run.path.columns.indexOf(c) > after && c !== 'negative_rigid' && !c.startsWith('eigenvalue_')
    && new Set(run.path.column(c)).size > 1);
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
  const columns = run.path.numeric().map((c) => [c, inWords(c)]), [x, y] = firstColumns(run);
  const keep = (id, usual) => (columns.some(([c]) => c === $(id).value) ? $(id).value : usual);
  fill($('x'), columns, keep('x', x)), fill($('y'), columns, keep('y', y));
  page.row = Math.max(0, run.path.rows - 1);
  $('row').max = page.row;
  $('transport').hidden = $('diagram-part').hidden = run.path.rows < 2;
  $('views').classList.toggle('single', run.path.rows < 2);
  $('size').parentElement.hidden = !run.shape || !run.shape.radius.length;
  $('colour').parentElement.hidden = !run.shape || !run.shape.fields.length;
  if (run.states.length) fill($('ghost'), [['', 'nothing'], ...run.states.map((s, k) => [k, nameOf(run, s)])], '');
  const fields = run.shape ? run.shape.fields : [], plain = !run.shape || run.shape.structures.length > 1 || !run.shape.bonds.length;
  fill($('colour'), [['', 'structure'], ...fields.map((f) => [f.key, f.name])], plain ? '' : fields[0].key);
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
  const critical = ['branch', 'limit'].includes(kindOf(label)) ? 'critical' : `unstable, index ${unstable}`;
  const parts = [`point ${row}`, label, `${run.in_time ? 'time' : 'load factor'} ${short(p.at(run.parameter, row))}`,
    p.has('stable') ? (p.at('stable', row) ? 'stable' : critical) : ''];
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
  const {run, state} = page, told = [];
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
  const {modes, contacts} = arrays(state), mode = modes[$('mode').value] || null, field = $('colour').value;
  const amplitude = mode ? page.swung ?? $('amplitude').value / 100 : 0, ghost = run.states[$('ghost').value] || null;
  shape.show(state, {ghost, mode, amplitude, field, size: $('size').value / 100});
  const counted = [plural(run.shape.radius.length, 'particle'), `${run.shape.bodies.length} bodies`, plural(contacts.length, 'contact')];
  $('shape').setAttribute('aria-label', `${run.title || run.name}, ${nameOf(run, state)}: ${counted.join(', ')}`);
  showLegend(field);
}

function showLegend(field) {
  const run = page.run, t = theme(), rows = [], f = run.shape.fields.find((g) => g.key === field);
  const line = (text, look, background) => {
    const row = element('div'), mark = element('span', null, {class: look});
    mark.style.background = background;
    row.append(mark, element('span', text));
    rows.push(row);
  };
  const swatch = (colour, text) => line(text, 'swatch', colour);
  if (f) {
    const most = short(+(shape.reach[field] || 0).toPrecision(2)), from = shape.signed[field] ? 0 : 0.5;
    const colours = d3.range(from, 1.01, 0.1).map((v) => d3.interpolateRdBu(1 - v)).join(',');
    line(`${f.name}, ${from ? '0' : `−${most}`} to ${most}`, 'ramp', `linear-gradient(90deg, ${colours})`);
  } else if (run.shape.structures.length > 1 && run.shape.structures.length < 9)
    run.shape.structures.forEach((s, k) => swatch(seriesColour(t, k), s.name));
  if (arrays(page.state).contacts.length && shape.most > 0)
    swatch(t.index[0], `contact forces, at most ${short(+shape.most.toPrecision(3))}`);
  if (page.state.loads.some((v) => v)) swatch(t.series[2], 'loads');
  if (shape.mounts.some((m) => m.visible)) swatch(t.quiet, 'held: bars, directions; rings, turns');
  if (shape.enlarged) line('particles are drawn larger than they are', '', '');
  $('legend').replaceChildren(...rows);
}

const sentences = {branch: 'a branch point', limit: 'a limit point: the load factor turns back', initial: 'the start', final: 'the end'};

/// A row of a table: cells are elements or text, those in `numbers` (by their place) to the right.
function tableRow(tag, cells, numbers = [], attributes = {}) {
  const tr = element('tr', null, attributes);
  tr.append(...cells.map((c, k) => {
    const cell = element(tag, null, numbers.includes(k) ? {class: 'number'} : {});
    cell.append(c);
    return cell;
  }));
  return tr;
}

function showEvents() {
  const run = page.run, labels = run.path.column('label'), drops = new Map(snaps(run).map((f) => [f.label, f.freed]));
  const rows = d3.range(run.path.rows).filter((k) => labels[k]);
  $('events-part').hidden = !rows.length;
  const head = tableRow('th', ['event', run.in_time ? 'time' : 'load factor', 'energy', 'what'], [1, 2]);
  $('events').replaceChildren(head, ...rows.map((k) => {
    const event = run.events.column('label').indexOf(labels[k]), of = (column) => (event >= 0 ? run.events.at(column, event) : undefined);
    const kind = kindOf(labels[k]), freed = drops.get(labels[k]), button = element('button', labels[k]);
    const before = of('negative_before'), after = of('negative_after');
    const named = kind === 'event' ? (event >= 0 ? 'the observable reaches its value' : 'the stage ends') : '';
    const told = [kind === 'jump' ? 'it snaps to another equilibrium' : of('what') || sentences[kind] || named,
      before === 0 && after > 0 ? 'stability is lost' : before > 0 && after === 0 ? 'stability is won back' : '',
      freed !== undefined ? `${short(freed)} of energy is set free` : '',
      before !== after && before >= 0 ? `Morse index ${before} → ${after}` : ''];
    button.onclick = () => select(k);
    return tableRow('td', [button, short(run.path.at(run.parameter, k)), short(run.path.at('energy', k)), told.filter((s) => s).join('; ')],
      [1, 2], {'data-row': k});
  }));
  const together = short(d3.sum([...drops.values()]));
  $('freed').textContent = drops.size > 1 ? `Together the ${drops.size} snaps set ${together} of energy free.` : '';
}

/// A number to the second digit of its error.
function withError(value, error) {
  if (!Number.isFinite(error)) return short(value);
  const digits = error > 0 ? Math.max(0, Math.min(20, 1 - Math.floor(Math.log10(error)))) : 15;
  return `${value.toFixed(digits)} ± ${error.toPrecision(2)}`;
}

function showRefined() {
  const table = new Table(report.refined), levels = table.columns.filter((c) => c.startsWith('level_'));
  const numbers = [2, 3, ...levels.map((_, i) => 5 + i)], number = (column, k) => asNumber(table.at(column, k));
  const head = tableRow('th', ['at', 'quantity', 'value ± error', 'order', 'approach', ...levels.map((c) => c.replace('_', ' '))], numbers);
  $('refined-part').hidden = false, $('sweep-title').textContent = 'The levels';
  $('refined').replaceChildren(head, ...d3.range(table.rows).map((k) => {
    const order = number('order', k), value = withError(number('value', k), number('error', k));
    const cells = [table.at('at', k), table.at('quantity', k), value, Number.isFinite(order) ? order.toFixed(2) : '', table.at('approach', k)];
    return tableRow('td', [...cells, ...levels.map((c) => short(number(c, k)))], numbers);
  }));
}

function drawCharts() {
  const run = page.run, all = {curve: drawCurve, landscape: drawLandscape, energy: drawEnergies, contacts: drawContacts, eigenvalues: drawEigenvalues, iterations: drawIterations};
  const drawn = () => Object.entries(all).map(([id, draw]) => [id, draw($(id), run, page.row, select)]);
  for (const [id, there] of drawn()) $(`${id}-part`).hidden = !there;
  drawn();                                                     // once more, as wide as they are now
}

function showAbout() {
  const run = page.run, facts = [], count = run.expected.length, met = run.expected.filter((e) => e.met).length;
  const fact = (name, value, tag = 'span') => {
    if (!value) return;
    const d = element('dd');
    d.append(element(tag, value));
    facts.push(element('dt', name), d);
  };
  $('met').hidden = $('expected-part').hidden = !count;
  $('met').textContent = `${met} of ${count} expectations of the problem file are met.`;
  $('met').className = met === count ? 'good' : 'bad';
  $('expected-part').open = met < count;
  $('expected-count').textContent = `The ${plural(count, 'expectation')} of the problem file, ${met} met`;
  $('expected').replaceChildren(tableRow('th', ['expected', 'at', 'value', 'reached', '', 'source']), ...run.expected.map((e) =>
    tableRow('td', [e.column, e.at, short(e.expected), short(e.value),
      element('span', e.met ? '✓ met' : '✗ not met', {class: e.met ? 'good' : 'bad'}), e.source])));
  fact('problem file', run.input.file), fact('its SHA-256', run.input.sha256, 'code');
  fact('elamin', run.version), fact('directory', run.directory);
  fact('tolerances', Object.entries(run.tolerances).map(([k, v]) => `${k} ${short(v)}`).join(', '));
  fact('seconds', Object.entries(run.times).map(([k, v]) => `${k} ${+v.toPrecision(3)}`).join(', '));
  fact('free at the end', run.zero_modes.join(', '));
  fact('the run again', `elamin ${quoted(`${run.directory}/resolved.toml`)} -o again`, 'code');
  fact('this page again', report.command, 'code');
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
  const how = {logX: $('sweep-log-x').checked, logY: $('sweep-log-y').checked, chosen: page.run.number, choose: (k) => runs[k] && open(k)};
  drawSweep($('sweep-plot'), sweep, $('sweep-x').value, $('sweep-y').value, how);
}

function stop() {
  cancelAnimationFrame(page.timer);
  page.timer = 0;
  $('play').textContent = '▶ Play';
  $('play').setAttribute('aria-pressed', 'false');
}
function play() {
  if (page.timer) return stop();
  const rows = page.run.path.rows, seconds = Math.min(12, Math.max(3, rows / 10)), from = page.row >= rows - 1 ? 0 : page.row;
  const began = performance.now();
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
  const numeric = sweep.numeric(), swept = sweep.columns.slice(0, sweep.columns.indexOf('status')).filter((c) => numeric.includes(c));
  const threshold = ['branch:1', 'limit:1', 'contact:1'].find((c) => sweep.column(c).some((v) => v !== null));
  const entries = numeric.map((c) => [c, c]);
  fill($('sweep-x'), entries, swept.find((c) => !c.startsWith('expect.')) || swept[0]);
  fill($('sweep-y'), entries, threshold || firstColumns(runs[0])[1]);
}
if (report.refined) showRefined();
if (runs.length > 1) {
  $('overlay').checked = runs.length <= 12;
  if (!sweep) {
    $('sweep').hidden = false, $('sweep-title').textContent = 'The runs';
    for (const part of $('sweep').querySelectorAll('.tools, #sweep-plot')) part.remove();
  }
  $('multiples').append(...runs.map((run, k) => {
    const b = element('button', null, {'data-run': k, title: run.name}), root = d3.create('svg:svg'), t = theme();
    const [x, y] = firstColumns(run), all = points(run, x, y);
    const sx = d3.scaleLinear(d3.extent(all, (p) => p.x), [4, 116]), sy = d3.scaleLinear(d3.extent(all, (p) => p.y), [56, 4]);
    const line = d3.line().x((p) => sx(p.x)).y((p) => sy(p.y));
    root.attr('viewBox', '0 0 120 60').attr('aria-hidden', 'true');
    for (const {points: of, stable, negative} of pieces(all).lines)
      put(root, 'path', {d: line(of), fill: 'none', stroke: stable ? t.series[0] : indexColour(t, negative), 'stroke-width': 1.5});
    b.append(root.node(), element('span', run.name));
    b.onclick = () => open(k);
    return b;
  }));
}
open(0);
