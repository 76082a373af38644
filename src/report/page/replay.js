// Shows a run again in three dimensions. Data: the JSON in #replay-data; library: three.js.
// Leaves on <html>: data-replay-frames, data-replay-triangles (what is drawn), data-replay-drawn (pixels that are not
// background, of the first picture), data-replay-marks (contacts and pairs of cells shown), data-replay-front (boxes
// shown), data-error (a failure).
'use strict';
(() => {
  const root = document.documentElement;
  const element = (id) => document.getElementById(id);
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const floats = (text) => new Float32Array(bytes(text).buffer);
  const whole = (text) => new Uint32Array(bytes(text).buffer);
  const data = JSON.parse(element('replay-data').textContent);
  const times = floats(data.times), poses = floats(data.poses), felt = floats(data.felt);
  const markEnds = whole(data.markEnds), marks = floats(data.marks);
  const canvas = element('replay-view');
  const slider = element('replay-time');
  slider.max = Math.max(0, times.length - 1);
  root.dataset.replayFrames = times.length;

  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
  } catch (failure) {
    element('replay-text').textContent = 'This browser has no WebGL, so there is no picture; the numbers are in the charts.';
    return;
  }
  const dark = matchMedia('(prefers-color-scheme: dark)').matches;
  const background = dark ? 0x1b2025 : 0xffffff;
  renderer.setClearColor(background);
  const scene = new THREE.Scene();
  scene.add(new THREE.HemisphereLight(0xffffff, 0x667788, 0.75));
  const sun = new THREE.DirectionalLight(0xffffff, 0.55);
  sun.position.set(0.4, -0.7, 1.0);
  scene.add(sun);

  // Bodies -----------------------------------------------------------------------------------------------------------
  const geometries = data.meshes.map((mesh) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(floats(mesh.vertices), 3));
    geometry.setIndex(new THREE.BufferAttribute(whole(mesh.indices), 1));
    geometry.computeBoundingSphere();
    return geometry;
  });
  const boxes = data.meshes.map((mesh) => floats(mesh.boxes));
  const place = (object, numbers, at) => {
    object.position.set(numbers[at], numbers[at + 1], numbers[at + 2]);
    object.quaternion.set(numbers[at + 3], numbers[at + 4], numbers[at + 5], numbers[at + 6]);
  };
  const movers = [], objects = [];
  let tool = null, triangles = 0;
  for (const body of data.bodies) {
    const material = new THREE.MeshPhongMaterial({color: body.tool ? 0xc77700 : body.moves ? 0x3a9fd6 : 0x9aa5ad,
      side: THREE.DoubleSide, flatShading: true, shininess: 12});
    const object = new THREE.Mesh(geometries[body.mesh], material);
    place(object, floats(body.pose), 0);
    scene.add(object);
    object.userData = {boxes: boxes[body.mesh], moves: body.moves};
    objects.push(object);
    triangles += geometries[body.mesh].index.count / 3;
    if (body.moves) movers.push(object);
    if (body.tool) tool = object;
  }
  root.dataset.replayTriangles = triangles;

  // The eye looks at the tool, or at everything where there is none, from so far that the tool's surroundings show.
  const all = new THREE.Box3().setFromObject(scene);
  const size = tool ? Math.max(4 * tool.geometry.boundingSphere.radius, 1e-9) : all.getSize(new THREE.Vector3()).length() / 2;
  const eye = {target: new THREE.Vector3(), distance: 2.2 * size, turn: -0.9, rise: 0.5};
  if (!tool) all.getCenter(eye.target);
  const camera = new THREE.PerspectiveCamera(40, 2, size / 100, size * 100 + all.getSize(new THREE.Vector3()).length() * 4);
  camera.up.set(0, 0, 1);

  // Force and hand ---------------------------------------------------------------------------------------------------
  const forceAt = (i) => Math.hypot(felt[8 * i], felt[8 * i + 1], felt[8 * i + 2]);
  let strongest = 0;  // frame
  for (let i = 0; i < times.length; ++i) if (forceAt(i) > forceAt(strongest)) strongest = i;
  const mostForce = Math.max(1e-9, times.length ? forceAt(strongest) : 0);
  const arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), size, 0xc2410c);
  const hand = new THREE.Mesh(new THREE.SphereGeometry(size / 40, 12, 8), new THREE.MeshBasicMaterial({color: 0x0072b2}));
  for (const part of [hand, arrow.line, arrow.cone]) {  // seen through the bodies: they begin inside of the tool
    part.material.depthTest = false;
    part.renderOrder = 1;
  }
  if (data.hand) scene.add(arrow, hand);

  // Contacts and pairs of cells: needles along the normal, seen through the bodies ---------------------------------------
  const needles = new THREE.LineSegments(new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({vertexColors: THREE.VertexColors || true, depthTest: false}));
  const heads = new THREE.Points(new THREE.BufferGeometry(),
    new THREE.PointsMaterial({size: 7, sizeAttenuation: false, vertexColors: THREE.VertexColors || true, depthTest: false}));
  needles.renderOrder = heads.renderOrder = 2;
  needles.frustumCulled = heads.frustumCulled = false;
  scene.add(needles, heads);
  const showMarks = () => {
    const first = frame > 0 ? markEnds[frame - 1] : 0, end = element('replay-marks').checked ? markEnds[frame] || 0 : first;
    const lines = [], points = [], lineColours = [], pointColours = [];
    for (let i = first; i < end; ++i) {
      const m = marks.subarray(8 * i, 8 * i + 8), cell = m[7] < 0;
      const colour = cell ? [0.85, 0.55, 0.0] : [0.75, 0.05, 0.1], length = (0.08 + 0.12 * Math.abs(m[7])) * size;
      lines.push(m[0], m[1], m[2], m[0] + length * m[3], m[1] + length * m[4], m[2] + length * m[5]);
      points.push(m[0], m[1], m[2]);
      lineColours.push(...colour, ...colour);
      pointColours.push(...colour);
    }
    const set = (object, positions, colours) => {
      object.geometry.dispose();
      object.geometry = new THREE.BufferGeometry();
      object.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(positions), 3));
      object.geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(colours), 3));
    };
    set(needles, lines, lineColours);
    set(heads, points, pointColours);
    root.dataset.replayMarks = end - first;
  };

  // The front: which boxes a search has to open. Boxes are apart if one of 15 axes parts them -----------------------------
  const front = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color: 0x7b3fa0}));
  front.frustumCulled = false;
  scene.add(front);
  const apart = (a, b, turn, shift) => {  // centres and halves; b's axes and origin in a's frame
    const t = [0, 1, 2].map((k) => shift[k] + turn[k][0] * b[0] + turn[k][1] * b[1] + turn[k][2] * b[2] - a[k]);
    const r = turn.map((row) => row.map((x) => Math.abs(x) + 1e-6));
    for (let i = 0; i < 3; ++i) {
      if (Math.abs(t[i]) > a[3 + i] + r[i][0] * b[3] + r[i][1] * b[4] + r[i][2] * b[5]) return true;
      const along = t[0] * turn[0][i] + t[1] * turn[1][i] + t[2] * turn[2][i];
      if (Math.abs(along) > b[3 + i] + r[0][i] * a[3] + r[1][i] * a[4] + r[2][i] * a[5]) return true;
    }
    for (let i = 0; i < 3; ++i) {
      for (let j = 0; j < 3; ++j) {
        const i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const gap = Math.abs(t[i2] * turn[i1][j] - t[i1] * turn[i2][j]);
        if (gap > a[3 + i1] * r[i2][j] + a[3 + i2] * r[i1][j] + b[3 + j1] * r[i][j2] + b[3 + j2] * r[i][j1]) return true;
      }
    }
    return false;
  };
  const openBoxes = (a, b, opened, left) => {  // objects; adds the deepest boxes of both that are not apart
    const relative = new THREE.Matrix4().copy(a.matrixWorld);
    const inverse = a.matrixWorld.clone();
    if (inverse.invert) inverse.invert(); else inverse.getInverse(relative);
    const e = inverse.multiply(b.matrixWorld).elements;
    const turn = [[e[0], e[4], e[8]], [e[1], e[5], e[9]], [e[2], e[6], e[10]]], shift = [e[12], e[13], e[14]];
    const boxA = a.userData.boxes, boxB = b.userData.boxes, countA = boxA.length, countB = boxB.length;
    const stack = countA && countB ? [[0, 0]] : [];
    while (stack.length && left.tests > 0) {
      const [i, j] = stack.pop();
      --left.tests;
      if (apart(boxA.subarray(8 * i, 8 * i + 6), boxB.subarray(8 * j, 8 * j + 6), turn, shift)) continue;
      const openA = boxA[8 * i + 7], openB = boxB[8 * j + 7];  // children; 6: the first one
      if (!openA && !openB) {
        opened.get(a).add(i);
        opened.get(b).add(j);
      } else if (openA && (!openB || boxA[8 * i + 3] + boxA[8 * i + 4] + boxA[8 * i + 5] >= boxB[8 * j + 3] + boxB[8 * j + 4] + boxB[8 * j + 5])) {
        for (let k = 0; k < openA; ++k) stack.push([boxA[8 * i + 6] + k, j]);
      } else {
        for (let k = 0; k < openB; ++k) stack.push([i, boxB[8 * j + 6] + k]);
      }
    }
  };
  const edges = [0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7, 7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7];
  const showFront = () => {
    front.visible = element('replay-front').checked;
    root.dataset.replayFront = 0;
    if (!front.visible) return;
    scene.updateMatrixWorld();
    const opened = new Map(objects.map((object) => [object, new Set()])), left = {tests: 40000};
    objects.forEach((a, i) => objects.slice(i + 1).forEach((b) => {
      if (a.userData.moves || b.userData.moves) openBoxes(a, b, opened, left);
    }));
    const positions = [];
    let shown = 0;
    for (const [object, set] of opened) {
      for (const i of set) {
        const box = object.userData.boxes.subarray(8 * i, 8 * i + 6);
        const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((c) => new THREE.Vector3(box[0] + (c & 1 ? 1 : -1) * box[3],
          box[1] + (c & 2 ? 1 : -1) * box[4], box[2] + (c & 4 ? 1 : -1) * box[5]).applyMatrix4(object.matrixWorld));
        for (const c of edges) positions.push(corners[c].x, corners[c].y, corners[c].z);
        ++shown;
      }
    }
    front.geometry.dispose();
    front.geometry = new THREE.BufferGeometry();
    front.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(positions), 3));
    root.dataset.replayFront = shown;
  };

  let frame = 0;
  const show = () => {
    movers.forEach((object, k) => place(object, poses, 7 * (frame * movers.length + k)));
    const at = 8 * frame;
    const force = new THREE.Vector3(felt[at], felt[at + 1], felt[at + 2]);
    if (tool) eye.target.copy(tool.position);
    if (data.hand && tool) {
      hand.position.set(felt[at + 3], felt[at + 4], felt[at + 5]);
      arrow.visible = force.length() > 1e-3 * mostForce;
      arrow.position.copy(tool.position);
      if (arrow.visible) arrow.setDirection(force.clone().normalize());
      arrow.setLength(Math.max(1e-3, force.length() / mostForce) * 0.7 * size, size / 8, size / 14);
    }
    showMarks();
    showFront();
    const width = canvas.clientWidth || 800, height = canvas.clientHeight || 420;
    renderer.setPixelRatio(window.devicePixelRatio || 1);
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    camera.position.set(eye.target.x + eye.distance * Math.cos(eye.rise) * Math.cos(eye.turn),
      eye.target.y + eye.distance * Math.cos(eye.rise) * Math.sin(eye.turn), eye.target.z + eye.distance * Math.sin(eye.rise));
    camera.lookAt(eye.target);
    renderer.render(scene, camera);
    slider.value = frame;
    const newton = force.length();
    element('replay-text').textContent = `${(times[frame] || 0).toFixed(2)} s   ` +
      (data.hand ? `${newton.toFixed(2)} N   ` : '') + `${felt[at + 7] || 0} contacts, ${(felt[at + 6] || 0).toFixed(2)} mm deep`;
  };

  // Controls ---------------------------------------------------------------------------------------------------------
  let playing = false, began = 0, from = 0;
  const step = (now) => {
    if (!playing) return;
    const t = from + (now - began) / 1e3;
    while (frame + 1 < times.length && times[frame + 1] <= t) ++frame;
    show();
    if (frame + 1 >= times.length) return stop();
    requestAnimationFrame(step);
  };
  const stop = () => { playing = false; element('replay-play').textContent = 'Play'; };
  const toggle = () => {
    if (playing) return stop();
    if (frame + 1 >= times.length) frame = 0;
    playing = true;
    began = performance.now();
    from = times[frame] || 0;
    element('replay-play').textContent = 'Pause';
    requestAnimationFrame(step);
  };
  element('replay-play').addEventListener('click', toggle);
  slider.addEventListener('input', () => { stop(); frame = Number(slider.value); show(); });
  canvas.addEventListener('keydown', (event) => {
    if (event.key === ' ') { event.preventDefault(); toggle(); }
    const way = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    if (way) { stop(); frame = Math.min(times.length - 1, Math.max(0, frame + way)); show(); }
  });
  let held = null;
  canvas.addEventListener('pointerdown', (event) => { held = event; canvas.setPointerCapture(event.pointerId); canvas.focus(); });
  canvas.addEventListener('pointerup', () => { held = null; });
  canvas.addEventListener('pointermove', (event) => {
    if (!held) return;
    eye.turn -= (event.clientX - held.clientX) / 150;
    eye.rise = Math.min(1.5, Math.max(-1.5, eye.rise + (event.clientY - held.clientY) / 150));
    held = event;
    show();
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    eye.distance = Math.min(size * 60, Math.max(size / 10, eye.distance * Math.exp(event.deltaY / 600)));
    show();
  }, {passive: false});
  window.addEventListener('resize', show);
  for (const id of ['replay-marks', 'replay-front']) element(id).addEventListener('change', show);

  if (times.length === 0) { renderer.render(scene, camera); return; }
  frame = strongest;
  show();
  const gl = renderer.getContext();
  const picture = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, picture);
  let drawn = 0;
  for (let i = 0; i < picture.length; i += 4) {
    if (picture[i] !== background >> 16 || picture[i + 1] !== (background >> 8 & 255) || picture[i + 2] !== (background & 255)) ++drawn;
  }
  root.dataset.replayDrawn = drawn;
})();
