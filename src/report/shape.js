'use strict';
// The structure at a stored state, in three dimensions.

const up = new THREE.Vector3(0, 1, 0);
const vector = (a) => new THREE.Vector3(a[0], a[1], a[2]);
const place = (x, k) => vector(x.subarray(3 * k, 3 * k + 3));
const still = new THREE.Quaternion();
const evenly = (size) => new THREE.Vector3().setScalar(size);
const turnTo = (from, to) => new THREE.Quaternion().setFromUnitVectors(from, to);
const axes = ['x', 'y', 'z'].map((_, c) => new THREE.Vector3().setComponent(c, 1));

/// Many copies of a form, each with its own place, turn, size and colour.
class Copies {
  constructor(geometry, count, material = {}) {
    this.colours = new THREE.InstancedBufferAttribute(new Float32Array(3 * count).fill(1), 3);
    geometry.setAttribute('color', this.colours);
    this.mesh = new THREE.InstancedMesh(geometry, new THREE.MeshLambertMaterial({vertexColors: THREE.VertexColors, ...material}), count);
    this.mesh.frustumCulled = false;
    this.matrix = new THREE.Matrix4();
  }
  /// `of(k)`: place, turn, size and colour of copy k.
  put(of) {
    for (let k = 0; k < this.mesh.count; ++k) {
      const [place, turn, size, colour] = of(k);
      this.mesh.setMatrixAt(k, this.matrix.compose(place, turn, size));
      this.colours.setXYZ(k, colour.r, colour.g, colour.b);
    }
    this.mesh.instanceMatrix.needsUpdate = this.colours.needsUpdate = true;
  }
}

class ShapeView {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
    this.lamp = new THREE.DirectionalLight(0xffffff, 0.65);
    new ResizeObserver(() => this.render()).observe(canvas);
  }

  /// Builds what a run's states have in common.
  open(run) {
    this.run = run;
    this.close();
    this.scene = new THREE.Scene();
    this.scene.add(new THREE.AmbientLight(0xffffff, 0.55), this.lamp, this.lamp.target);
    const s = run.shape, n = s.radius.length, fine = n > 500 ? [14, 10] : [24, 16];
    const ball = n > 2000 ? new THREE.IcosahedronBufferGeometry(1, 1) : new THREE.SphereBufferGeometry(1, ...fine);
    this.measure();
    const least = 0.004 * this.extent;                          // what is smaller would not be seen
    this.radius = Array.from(s.radius, (r) => Math.max(r, least));
    this.enlarged = s.radius.some((r) => r < least);
    const middle = d3.median(this.radius);
    this.thick = Math.max(0.22 * middle, Math.min(middle, 0.0025 * this.extent));
    this.balls = new Copies(ball, n);
    this.rods = new Copies(new THREE.CylinderBufferGeometry(1, 1, 1, 8, 1, true), s.bonds.length / 2);
    this.ghostBalls = new Copies(ball.clone(), n, {transparent: true, opacity: 0.28, depthWrite: false});
    this.held = new Map();                                      // particles that cannot move in two directions, and by which supports
    s.supports.forEach((p, k) => { if (p.held.length > 1) for (const q of p.particles) this.held.set(q, [...this.held.get(q) || [], k]); });
    this.blocks = new Copies(new THREE.BoxBufferGeometry(2.15, 2.15, 2.15), this.held.size,
      {transparent: true, opacity: 0.3, depthWrite: false});
    this.mounts = s.supports.flatMap((p, k) => p.bodies.map((b) => this.mount(p, k, b)));
    this.bodies = this.solids(1), this.ghostBodies = this.solids(0.28);
    this.walls = s.walls.map((w) => this.wall(w));
    this.arrows = new THREE.Group();
    this.scene.add(this.balls.mesh, this.rods.mesh, this.ghostBalls.mesh, this.blocks.mesh, this.arrows, ...this.bodies,
        ...this.ghostBodies, ...this.mounts, ...this.walls);
    this.look('');
  }
  close() {
    if (this.scene) this.scene.traverse((o) => { if (o.geometry) o.geometry.dispose(); if (o.material) o.material.dispose(); });
  }

  /// The box around every stored state, the largest contact force, and how far the values of each field reach.
  measure() {
    this.box = new THREE.Box3(), this.most = 0, this.reach = {}, this.signed = {};
    this.reaches = this.run.shape.bodies.map((b) => Math.max(...Array.from(this.run.shape.surfaces[b.shape].points, Math.abs)));
    for (const state of this.run.states) {
      const a = arrays(state);
      for (let k = 0; 3 * k < a.x.length; ++k) this.box.expandByPoint(place(a.x, k));
      for (let k = 0; k < a.poses.length; k += 7) {
        const p = vector(a.poses.subarray(k, k + 3)), r = this.reaches[k / 7];
        this.box.expandByPoint(p.clone().addScalar(r)).expandByPoint(p.clone().addScalar(-r));
      }
      for (const c of a.contacts) this.most = Math.max(this.most, c.size);
      for (const [name, values] of Object.entries(a.fields))
        for (const v of values) this.reach[name] = Math.max(this.reach[name] || 0, Math.abs(v)), this.signed[name] ||= v < 0;
    }
    this.box.expandByScalar(d3.max(this.run.shape.radius) || 0);
    if (this.box.isEmpty()) this.box.expandByPoint(new THREE.Vector3());
    this.extent = Math.max(this.box.getSize(new THREE.Vector3()).length(), 1e-30);
  }

  solids(opacity) {
    const t = theme(), forms = this.run.shape.surfaces.map((f) => {
      const flat = new THREE.BufferGeometry();
      flat.setAttribute('position', new THREE.BufferAttribute(f.points, 3));
      flat.setIndex(new THREE.BufferAttribute(new Uint32Array(f.triangles), 1));
      const g = flat.toNonIndexed();
      g.computeVertexNormals();
      return g;
    });
    const look = (k) => ({color: seriesColour(t, this.structureOfBody(k)), transparent: opacity < 1, opacity, depthWrite: opacity === 1});
    return this.run.shape.bodies.map((b, k) => new THREE.Mesh(forms[b.shape], new THREE.MeshLambertMaterial(look(k))));
  }
  structureOf(k) { return this.run.shape.structures.findIndex((s) => k >= s.first && k < s.first + s.count); }
  structureOfBody(b) {
    const k = this.run.shape.structures.findIndex((s) => b >= s.first_body && b < s.first_body + s.bodies);
    return this.run.shape.structures.length > 1 ? k : b;
  }

  /// What holds a body: a bar in every direction in which it cannot move, a ring about every axis about which it cannot turn.
  mount(support, k, body) {
    const group = new THREE.Group(), look = {color: theme().quiet, transparent: true, opacity: 0.75, depthTest: false};
    const material = new THREE.MeshBasicMaterial(look);
    const add = (geometry, turn, at) => {
      const part = new THREE.Mesh(geometry, material);
      part.position.copy(at), part.quaternion.copy(turn), part.renderOrder = 1;
      group.add(part);
    };
    axes.forEach((axis, c) => {
      const along = turnTo(up, axis), ends = [1.25, -1.25].map((f) => axis.clone().multiplyScalar(f)), none = new THREE.Vector3();
      if (support.held.includes('xyz'[c])) {
        add(new THREE.CylinderBufferGeometry(0.02, 0.02, 2.5, 8), along, none);
        for (const end of ends) add(new THREE.CylinderBufferGeometry(0.14, 0.14, 0.03, 24), along, end);
      }
      if (support.turns.includes('xyz'[c])) add(new THREE.TorusBufferGeometry(0.5, 0.02, 6, 48), turnTo(axes[2], axis), none);
    });
    group.scale.setScalar(this.reaches[body]);
    group.userData = {support: k, body};
    return group;
  }

  wall(w) {
    const size = this.extent, centre = this.box.getCenter(new THREE.Vector3()), group = new THREE.Group(), color = theme().quiet;
    const turned = (form, from, to) => form.applyMatrix(new THREE.Matrix4().makeRotationFromQuaternion(turnTo(from, to)));
    let g, place = w.center ? vector(w.center) : null;
    if (w.shape === 'plane') {
      const n = vector(w.normal);
      g = turned(new THREE.PlaneBufferGeometry(1.3 * size, 1.3 * size), axes[2], n);
      place = centre.sub(n.clone().multiplyScalar(n.dot(centre.clone().sub(place))));
    } else if (w.shape === 'block') {
      const end = (v, c, side) => (Number.isFinite(v) ? v : centre.getComponent(c) + side * 0.8 * size);
      const lo = vector(w.lo.map((v, c) => end(v, c, -1))), hi = vector(w.hi.map((v, c) => end(v, c, 1)));
      g = new THREE.BoxBufferGeometry(...hi.clone().sub(lo).toArray());
      place = lo.add(hi).multiplyScalar(0.5);
    } else if (w.shape === 'sphere') {
      g = new THREE.SphereBufferGeometry(w.radius, 32, 20);
    } else {
      const middle = centre.getComponent(w.axis), lo = w.lo ?? middle - 0.7 * size, hi = w.hi ?? middle + 0.7 * size;
      g = turned(new THREE.CylinderBufferGeometry(w.radius_hi, w.radius_lo, hi - lo, 40, 1, true), up, axes[w.axis]);
      place.setComponent(w.axis, (lo + hi) / 2);
    }
    const faces = {color, transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false};
    group.add(new THREE.Mesh(g, new THREE.MeshBasicMaterial(faces)));
    const edges = new THREE.LineBasicMaterial({color, transparent: true, opacity: 0.7});
    group.add(new THREE.LineSegments(new THREE.EdgesGeometry(g, 20), edges));
    group.userData = {place, radius: w.radius || w.radius_lo || 0, axis: w.axis};
    return group;
  }

  /// Shows a state; `ghost`: another one behind it; `mode` and `amplitude`: moved along a mode, of the extent.
  show(state, {ghost = null, mode = null, amplitude = 0, field = '', size = 1} = {}) {
    this.shown = {state, ghost, mode, amplitude, field, size};
    if (!this.run.shape || !state) return;
    const a = arrays(state), s = this.run.shape, stage = s.stages[state.stage];
    const x = this.positions = Float32Array.from(a.x);
    let scale = 0;
    if (mode) {
      const longest = (of, step) => d3.max(d3.range(0, of.length, step), (k) => Math.hypot(of[k], of[k + 1], of[k + 2])) || 0;
      const most = Math.max(longest(mode.u, 3), longest(mode.v, 6));
      scale = most > 0 ? 0.15 * amplitude * this.extent / most : 0;
      for (let k = 0; k < x.length; ++k) x[k] += scale * mode.u[k];
    }
    const tints = this.tints(a, field, stage), grey = new THREE.Color(theme().quiet), held = [...this.held];
    this.balls.put((k) => [place(x, k), still, evenly(stage.absent.has(k) ? 0 : size * this.radius[k]), tints.particles[k]]);
    this.rods.put((b) => {
      const [p, q] = [place(x, s.bonds[2 * b]), place(x, s.bonds[2 * b + 1])], along = q.clone().sub(p), length = along.length();
      const thick = stage.unbound.has(b) ? 0 : this.thick, size = new THREE.Vector3(thick, length, thick);
      return [p.add(q).multiplyScalar(0.5), turnTo(up, along.divideScalar(length || 1)), size, tints.bonds[b]];
    });
    this.blocks.put((k) => {
      const [p, supports] = held[k], there = supports.some((i) => stage.supports[i]) && !stage.absent.has(p);
      return [place(x, p), still, evenly(there ? this.radius[p] : 0), grey];
    });
    this.pose(this.bodies, a.poses, mode, scale);
    this.bodies.forEach((body, b) => { body.visible = !stage.absent.has(this.radius.length + b); });
    for (const m of this.mounts) m.position.copy(this.bodies[m.userData.body].position), m.visible = stage.supports[m.userData.support];
    this.behind(ghost, grey);
    this.walls.forEach((w, k) => {
      w.visible = stage.walls[k];
      const [dx, dy, dz, growth] = state.walls[k], radius = w.userData.radius, f = radius > 0 ? (radius + growth) / radius : 1;
      w.position.copy(w.userData.place).add(new THREE.Vector3(dx, dy, dz));
      w.scale.set(...[0, 1, 2].map((c) => (c === w.userData.axis ? 1 : f)));
    });
    this.draw(state, a, x, stage.absent);
    this.render();
  }
  behind(ghost, colour) {
    this.ghostBalls.mesh.visible = !!ghost;
    for (const b of this.ghostBodies) b.visible = !!ghost;
    if (!ghost) return;
    const a = arrays(ghost), {absent} = this.run.shape.stages[ghost.stage];
    this.ghostBalls.put((k) => [place(a.x, k), still, evenly(absent.has(k) ? 0 : this.radius[k]), colour]);
    this.pose(this.ghostBodies, a.poses, null, 0);
  }
  pose(meshes, poses, mode, scale) {
    meshes.forEach((m, b) => {
      const p = poses.subarray(7 * b, 7 * b + 7), v = mode ? mode.v.subarray(6 * b, 6 * b + 6) : [0, 0, 0, 0, 0, 0];
      const turn = vector(v.slice(3)).multiplyScalar(scale), angle = turn.length();
      m.position.copy(vector(p)).addScaledVector(vector(v), scale);
      m.quaternion.set(p[3], p[4], p[5], p[6]);
      if (angle > 0) m.quaternion.premultiply(new THREE.Quaternion().setFromAxisAngle(turn.normalize(), angle));
      m.updateMatrixWorld();
    });
  }

  /// Colours of particles and bonds: by structure, or by a field of bonds, of which a particle has the mean of its own.
  tints(a, field, {unbound}) {
    const s = this.run.shape, n = this.radius.length, t = theme(), none = new THREE.Color(t.rule);
    const plain = s.structures.map((_, k) => new THREE.Color(seriesColour(t, k)));
    const own = Array.from({length: n}, (_, k) => plain[this.structureOf(k)] || new THREE.Color(t.quiet));
    const ofFirst = (particles) => ({particles, bonds: Array.from({length: s.bonds.length / 2}, (_, b) => particles[s.bonds[2 * b]])});
    if (!field || !a.fields[field]) return ofFirst(own);
    const most = this.reach[field] || 1, values = a.fields[field], of = s.fields.find((f) => f.key === field).of;
    const colour = (v) => new THREE.Color(d3.interpolateRdBu(0.5 - 0.5 * v / most));
    if (of !== 'bond') {
      const known = (k) => of === 'particle' || s.structures[this.structureOf(k)]?.kind === 'sheet';
      return ofFirst(Array.from(values, (v, k) => (known(k) ? colour(v) : none)));
    }
    const sum = new Float64Array(n), count = new Float64Array(n);
    s.bonds.forEach((p, k) => { if (!unbound.has(k >> 1)) sum[p] += values[k >> 1], ++count[p]; });
    return {particles: own.map((_, k) => (count[k] ? colour(sum[k] / count[k]) : none)), bonds: Array.from(values, colour)};
  }

  /// Arrows: contact forces in their proportion to the largest of the run, and loads; torques as rings that turn.
  draw(state, a, x, absent) {
    const t = theme(), size = this.extent, onTop = (object) => {
      object.traverse((part) => {
        if (part.material) Object.assign(part.material, {depthTest: false, transparent: true});
        part.renderOrder = 1;
      });
      this.arrows.add(object);
    };
    const add = (from, force, length, colour) =>
      onTop(new THREE.ArrowHelper(vector(force).normalize(), vector(from), length, colour, 0.35 * length, 0.2 * length));
    this.arrows.traverse((part) => { if (part.material) part.material.dispose(); });
    this.arrows.remove(...this.arrows.children);
    const strongest = [...a.contacts].sort((c, d) => d.size - c.size).slice(0, 150).filter((c) => c.size > 1e-3 * this.most);
    for (const c of strongest)
      for (const sign of c.second >= 0 ? [1, -1] : [1])
        add(c.point, c.force.map((f) => sign * f), (0.02 + 0.12 * c.size / this.most) * size, t.index[0]);
    this.run.shape.loads.forEach((load, k) => {
      const acts = state.loads[k], forces = load.forces ||= decoded(load.force, Float32Array);
      const times = (v) => Array.from(v, (c) => acts * c), some = (v) => Math.hypot(...v) > 0;
      for (let p = 0; p < load.particles.length; p += Math.ceil(load.particles.length / 40)) {
        const f = times(forces.subarray(3 * p, 3 * p + 3)), q = load.particles[p];
        if (some(f) && !absent.has(q)) add(x.subarray(3 * q, 3 * q + 3), f, 0.09 * size, t.series[2]);
      }
      for (const b of load.bodies) {
        const force = times(load.on_body), torque = times(load.torque), body = this.bodies[b];
        const from = body.localToWorld(vector(load.point)).toArray(), length = Math.max(0.12 * size, 0.8 * this.reaches[b]);
        if (some(force)) add(from, force, length, t.series[2]);
        if (some(torque)) onTop(this.turning(body.position, vector(torque).normalize(), 1.15 * this.reaches[b], t.series[2]));
      }
    });
  }
  /// Three quarters of a ring about an axis, with a head where it leads to.
  turning(at, axis, radius, colour) {
    const group = new THREE.Group(), material = new THREE.MeshBasicMaterial({color: colour});
    this.ring ||= [new THREE.TorusBufferGeometry(1, 0.03, 6, 48, 1.5 * Math.PI),
      new THREE.ConeBufferGeometry(0.12, 0.3, 12).rotateZ(-Math.PI / 2).translate(0.1, -1, 0)];
    group.add(...this.ring.map((form) => new THREE.Mesh(form, material)));
    group.position.copy(at), group.quaternion.copy(turnTo(axes[2], axis)), group.scale.setScalar(radius);
    return group;
  }

  /// Looks along an axis; "": across what is flat or slender, else from a corner.
  look(axis) {
    const size = this.box.getSize(new THREE.Vector3()).toArray(), sorted = [1, 0, 2].sort((a, b) => size[a] - size[b]);
    const slender = size[sorted[0]] < 0.02 * size[sorted[2]] || size[sorted[1]] < 0.15 * size[sorted[2]];
    const along = axis ? 'xyz'.indexOf(axis) : this.run.shape.flat ?? (slender ? sorted[0] : -1);
    const back = vector([[1, 0, 0], [0, -1, 0], [0, 0, 1]][along] || [0.55, -0.75, 0.4]).normalize(), high = axes[along === 2 ? 1 : 2];
    const centre = this.box.getCenter(new THREE.Vector3()), right = high.clone().cross(back).normalize(), above = back.clone().cross(right);
    this.camera.up.copy(high);
    const span = (v) => size.reduce((sum, s, c) => sum + s * Math.abs(v.getComponent(c)), 0);     // of the box, along v
    const {clientWidth, clientHeight} = this.canvas, tall = Math.tan(THREE.Math.degToRad(this.camera.fov / 2));
    const aspect = (clientWidth || 1) / (clientHeight || 1);
    const away = 1.1 * Math.max(span(above) / 2 / tall, span(right) / 2 / (tall * aspect)) + span(back) / 2;
    this.camera.position.copy(centre).addScaledVector(back, Math.max(away, 1e-3 * this.extent));
    this.camera.near = this.extent / 500, this.camera.far = 40 * this.extent;
    if (this.controls) this.controls.dispose();
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;
    this.controls.target.copy(centre);
    this.controls.enableZoom = document.activeElement === this.canvas;
    this.canvas.onfocus = () => { this.controls.enableZoom = true; };
    this.canvas.onblur = () => { this.controls.enableZoom = false; };
    this.canvas.onpointerdown = () => this.canvas.focus();
    this.controls.addEventListener('change', () => this.render());
    this.controls.update();
    this.render();
  }
  /// Turns (arrow keys) or comes nearer (+, −).
  key(name) {
    const turn = turnTo(this.camera.up, up), offset = this.camera.position.clone().sub(this.controls.target).applyQuaternion(turn);
    const s = new THREE.Spherical().setFromVector3(offset);
    s.theta += {ArrowLeft: 0.12, ArrowRight: -0.12}[name] || 0;
    s.phi = Math.min(Math.PI - 0.01, Math.max(0.01, s.phi + ({ArrowUp: -0.12, ArrowDown: 0.12}[name] || 0)));
    s.radius *= {'+': 0.9, '-': 1.1}[name] || 1;
    this.camera.position.copy(this.controls.target).add(offset.setFromSpherical(s).applyQuaternion(turn.inverse()));
    this.controls.update();
    this.render();
  }

  render() {
    if (!this.scene) return;
    const {clientWidth: w, clientHeight: h} = this.canvas;
    if (!w || !h) return;
    this.renderer.setSize(w, h, false);
    this.camera.aspect = w / h;
    this.camera.updateProjectionMatrix();
    this.lamp.position.copy(this.camera.position).add(this.camera.up.clone().multiplyScalar(0.4 * this.extent));
    this.lamp.target.position.copy(this.controls ? this.controls.target : this.camera.position);
    this.renderer.render(this.scene, this.camera);
  }
}
