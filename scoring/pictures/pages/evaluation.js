// The tool: two maps on a canvas, the pose of one changed by hand, the figures of metric.js for it.
(() => {
  const $ = (id) => document.getElementById(id);
  const data = JSON.parse($('data').textContent);
  data.map = Metric.decode(data.map);
  data.truth = Metric.decode(data.truth);
  data.fields = {};
  const ROWS = [
    ['precision', 'precision', 3, ''], ['recall', 'recall', 3, ''],
    ['psi_m', 'psi', 3, ' m'], ['psi_literal_m', 'psi, eq. (5)', 3, ' m'],
    ['psi_occupied_map_m', 'psi, walls of the map', 3, ' m'],
    ['psi_occupied_truth_m', 'psi, walls of the truth', 3, ' m'], ['known', 'known', 3, ''],
  ];
  const canvas = $('view'), context = canvas.getContext('2d');
  const pose = {...data.pose};
  const view = {x: 0, y: 0, zoom: 20};  // centre [m] and pixels a metre
  let blend = 0.55;

  // #pose=X,Y,DEG,SCALE in the address starts the page at that pose.
  const asked = /pose=([^&]*)/.exec(location.hash);
  if (asked) {
    const [x, y, deg, scale = 1] = asked[1].split(',').map(Number);
    if ([x, y, deg, scale].every(Number.isFinite) && scale > 0) Object.assign(pose, {x, y, deg, scale});
  }

  function picture(grid, free, wall) {
    const image = document.createElement('canvas');
    image.width = grid.w;
    image.height = grid.h;
    const pixels = new ImageData(grid.w, grid.h), words = new Uint32Array(pixels.data.buffer);
    const colour = [0, free, wall];  // ABGR
    for (let y = 0; y < grid.h; ++y)
      for (let x = 0; x < grid.w; ++x)
        words[(grid.h - 1 - y) * grid.w + x] = colour[grid.cells[y * grid.w + x]];
    image.getContext('2d').putImageData(pixels, 0, 0);
    return image;
  }
  const mapPicture = picture(data.map, 0xffe8ecfc, 0xff2f2fd6);
  const truthPicture = picture(data.truth, 0xffffffff, 0xff913c0b);

  function centre(grid) {
    let sx = 0, sy = 0, n = 0;
    for (let y = 0, i = 0; y < grid.h; ++y)
      for (let x = 0; x < grid.w; ++x, ++i)
        if (grid.cells[i] !== 0) { sx += x + 0.5; sy += y + 0.5; ++n; }
    return n ? [grid.x0 + sx / n * grid.res, grid.y0 + sy / n * grid.res] : [grid.x0, grid.y0];
  }
  const mapCentre = centre(data.map);
  const onTruth = (p) => Metric.rigid(pose).forward(p[0] * pose.scale, p[1] * pose.scale);

  function drawGrid(image, grid, at, alpha) {
    const T = Metric.rigid(at), r = grid.res * at.scale, z = view.zoom * devicePixelRatio;
    const [x, y] = T.forward(grid.x0 * at.scale, (grid.y0 + grid.h * grid.res) * at.scale);
    context.setTransform(z * T.c * r, -z * T.s * r, z * T.s * r, z * T.c * r,
                         canvas.width / 2 + (x - view.x) * z, canvas.height / 2 - (y - view.y) * z);
    context.globalAlpha = alpha;
    context.drawImage(image, 0, 0);
  }

  function drawScaleBar() {
    const z = view.zoom * devicePixelRatio, room = 0.2 * canvas.width / z;
    const length = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].filter((l) => l <= room).pop() || 0.1;
    const y = canvas.height - 18 * devicePixelRatio, x = 18 * devicePixelRatio;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.globalAlpha = 1;
    context.fillStyle = '#1b1f24';
    context.fillRect(x, y, length * z, 3 * devicePixelRatio);
    context.font = `${12 * devicePixelRatio}px system-ui, sans-serif`;
    context.fillText(`${length} m`, x, y - 5 * devicePixelRatio);
  }

  // Pairs green and joined, what only the map has red, what only the truth has blue, what nobody judges grey.
  const shown = new Set(data.marks.length && data.marks[0].what === 'victims' ? [0] : []);
  function drawMarks() {
    const z = view.zoom * devicePixelRatio, d = devicePixelRatio;
    const pixel = ([x, y]) => [canvas.width / 2 + (x - view.x) * z, canvas.height / 2 - (y - view.y) * z];
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.globalAlpha = 1;
    context.font = `${12 * d}px system-ui, sans-serif`;
    context.lineWidth = 2 * d;
    const mark = (mark, [x, y], colour, cross) => {
      const r = 5 * d;
      context.strokeStyle = context.fillStyle = colour;
      context.beginPath();
      if (cross) {
        context.moveTo(x - r, y - r); context.lineTo(x + r, y + r);
        context.moveTo(x - r, y + r); context.lineTo(x + r, y - r);
      } else {
        context.arc(x, y, r, 0, 2 * Math.PI);
      }
      context.stroke();
      if (mark[2]) context.fillText(mark[2], x + 8 * d, y - 6 * d);
    };
    const box = ([, , , x1, y1, x2, y2], place, colour) => {
      if (x1 === undefined) return;
      context.strokeStyle = colour;
      context.lineWidth = d;
      context.beginPath();
      for (const corner of [[x1, y1], [x2, y1], [x2, y2], [x1, y2]]) context.lineTo(...place(corner));
      context.closePath();
      context.stroke();
      context.lineWidth = 2 * d;
    };
    const ofMap = (p) => pixel(onTruth(p));
    data.marks.forEach((marks, index) => {
      if (!shown.has(index)) return;
      for (const one of [...marks.map, ...marks.pairs.map(([map]) => map)]) box(one, ofMap, '#d62f2f');
      for (const one of [...marks.truth, ...marks.pairs.map(([, truth]) => truth)]) box(one, pixel, '#0b3c91');
      for (const [map, truth] of marks.pairs) {
        const a = pixel(onTruth(map)), b = pixel(truth);
        context.strokeStyle = '#1e8c28';
        context.beginPath();
        context.moveTo(...a);
        context.lineTo(...b);
        context.stroke();
        mark(['', '', ''], a, '#1e8c28', false);
        const name = [map[2], truth[2]].filter(Boolean).join(' = ');
        mark(marks.what === 'victims' ? [...b, name] : truth, b, '#1e8c28', false);
      }
      for (const one of marks.map) mark(one, pixel(onTruth(one)), '#d62f2f', true);
      for (const one of marks.truth) mark(one, pixel(one), '#0b3c91', false);
      for (const one of marks.unjudged) mark(one, pixel(onTruth(one)), '#6e6e6e', false);
    });
  }
  data.marks.forEach((marks, index) => {
    const label = document.createElement('label'), box = document.createElement('input');
    box.type = 'checkbox';
    box.checked = shown.has(index);
    box.addEventListener('change', () => {
      if (box.checked) shown.add(index); else shown.delete(index);
      redraw();
    });
    const words = marks.what === 'victims' ? ['found', 'false', 'missed'] : ['matched', 'of the map alone', 'of the truth alone'];
    const counts = marks.unjudged.length ? `${marks.unjudged.length} reported, not judged: no list of the true ones`
      : `${marks.pairs.length} ${words[0]}, ${marks.map.length} ${words[1]}, ${marks.truth.length} ${words[2]}`;
    const doubt = data.warning ? ' (at a pose that is not trusted)' : '';
    label.append(box, ` ${marks.what}${doubt}: ${counts}`);
    $('marks').append(label);
  });
  if (data.warning) {
    $('warning').textContent = `Not trusted: ${data.warning}`;
    $('warning').hidden = false;
  }

  function draw() {
    canvas.width = canvas.clientWidth * devicePixelRatio;
    canvas.height = canvas.clientHeight * devicePixelRatio;
    context.imageSmoothingEnabled = false;
    drawGrid(truthPicture, data.truth, {x: 0, y: 0, deg: 0, scale: 1}, 1);
    drawGrid(mapPicture, data.map, pose, blend);
    drawMarks();
    drawScaleBar();
  }

  function fit() {
    let x1 = Infinity, y1 = Infinity, x2 = -Infinity, y2 = -Infinity;
    const take = ([x, y]) => {
      x1 = Math.min(x1, x); x2 = Math.max(x2, x);
      y1 = Math.min(y1, y); y2 = Math.max(y2, y);
    };
    for (const u of [0, 1])
      for (const v of [0, 1]) {
        const corner = (g) => [g.x0 + u * g.w * g.res, g.y0 + v * g.h * g.res];
        take(corner(data.truth));
        take(onTruth(corner(data.map)));
      }
    view.x = (x1 + x2) / 2;
    view.y = (y1 + y2) / 2;
    view.zoom = 0.94 * Math.min(canvas.clientWidth / (x2 - x1), canvas.clientHeight / (y2 - y1));
  }

  function stale(yes) {
    $('figures').classList.toggle('stale', yes);
    $('figure-overlap').parentElement.classList.toggle('stale', yes);
  }
  function showFigures() {
    const figures = Metric.figures(data, pose);
    $('figures').innerHTML = ROWS.map(([key, label, digits, unit]) =>
      `<tr><th>${label}</th>` +
      `<td id="figure-${key}" data-value="${figures[key]}">${figures[key].toFixed(digits)}${unit}</td></tr>`).join('');
    $('figure-overlap').dataset.value = figures.overlap;
    $('figure-overlap').textContent = figures.overlap.toFixed(3);
    stale(false);
  }

  const text = (value, digits) => String(Number(value.toFixed(digits)));
  function showPose() {
    pose.deg = ((pose.deg + 180) % 360 + 360) % 360 - 180;
    $('turn').value = pose.deg;
    $('scale').value = Math.log2(pose.scale);
    $('blend').value = 100 * blend;
    $('turn-out').value = `${pose.deg.toFixed(1)} deg`;
    $('scale-out').value = pose.scale.toFixed(3);
    $('blend-out').value = `${Math.round(100 * blend)} % map`;
    for (const [id, value, digits] of [['x', pose.x, 3], ['y', pose.y, 3], ['deg', pose.deg, 3], ['s', pose.scale, 4]])
      if (document.activeElement !== $(id)) $(id).value = text(value, digits);
    const numbers = [text(pose.x, 4), text(pose.y, 4), text(pose.deg, 6)];
    if (pose.scale !== 1) numbers.push(text(pose.scale, 6));
    const apart = (key) => Math.abs(pose[key] - data.pose[key]);
    const moved = ['x', 'y', 'scale'].some((key) => apart(key) > 1e-9) || Math.abs(Math.sin(apart('deg') * Math.PI / 360)) > 1e-9;
    $('by-hand').textContent = `at the pose by hand, ${moved ? 'as the maps lie now' : 'which is still the pose at start'}`;
    $('command').textContent = `${data.command} --pose=${numbers.join(',')}`;
  }

  // The picture follows at once; the figures as soon as there is time, at once when they are quick.
  let waiting = 0, cost = 0, drawing = 0;
  function measure() {
    const begin = performance.now();
    showFigures();
    cost = performance.now() - begin;
  }
  function changed() {
    cancelAnimationFrame(drawing);
    drawing = requestAnimationFrame(() => {
      showPose();
      draw();
      clearTimeout(waiting);
      if (cost < 30) return measure();
      stale(true);
      waiting = setTimeout(measure, 80);
    });
  }
  const redraw = () => requestAnimationFrame(() => { showPose(); draw(); });

  /** Changes turn and scale while the point `p` of the map stays where it is. */
  function around(p, change) {
    const before = onTruth(p);
    change();
    const after = onTruth(p);
    pose.x += before[0] - after[0];
    pose.y += before[1] - after[1];
    changed();
  }
  const scaleBy = (factor) => around(mapCentre, () => { pose.scale = Math.min(10, Math.max(0.1, pose.scale * factor)); });
  const turnBy = (deg) => around(mapCentre, () => { pose.deg += deg; });
  const moveBy = (dx, dy) => { pose.x += dx; pose.y += dy; changed(); };
  const setBlend = (value) => { blend = Math.min(1, Math.max(0, value)); redraw(); };
  const reset = () => { Object.assign(pose, data.pose); changed(); };
  const showAll = () => { fit(); redraw(); };

  const metres = (event) => {
    const box = canvas.getBoundingClientRect();
    return [view.x + (event.clientX - box.left - box.width / 2) / view.zoom,
            view.y - (event.clientY - box.top - box.height / 2) / view.zoom];
  };
  let grip = null;
  canvas.addEventListener('pointerdown', (event) => {
    canvas.focus();
    canvas.setPointerCapture(event.pointerId);
    const kind = event.button === 1 || event.altKey ? 'view' : event.button === 2 || event.shiftKey ? 'turn' : 'move';
    grip = {kind, at: metres(event)};
    event.preventDefault();
  });
  canvas.addEventListener('pointermove', (event) => {
    if (!grip) return;
    const now = metres(event), dx = now[0] - grip.at[0], dy = now[1] - grip.at[1];
    if (grip.kind === 'view') {
      view.x -= dx;
      view.y -= dy;
      return redraw();  // the grip stays at the same metres
    }
    if (grip.kind === 'move') moveBy(dx, dy);
    if (grip.kind === 'turn') {
      const [cx, cy] = onTruth(mapCentre);
      const angle = (p) => Math.atan2(p[1] - cy, p[0] - cx);
      turnBy((angle(now) - angle(grip.at)) * 180 / Math.PI);
    }
    grip.at = now;
  });
  for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, () => { grip = null; });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    if (event.ctrlKey) return scaleBy(Math.exp(-event.deltaY * 0.0002));
    const before = metres(event);
    view.zoom *= Math.exp(-event.deltaY * 0.0015);
    const after = metres(event);
    view.x += before[0] - after[0];
    view.y += before[1] - after[1];
    redraw();
  }, {passive: false});

  addEventListener('keydown', (event) => {
    if (event.target.tagName === 'INPUT' && event.target.type === 'number') return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? 0.5 : 0.05, turn = event.shiftKey ? 5 : 0.2;
    const actions = {
      ArrowLeft: () => moveBy(-step, 0), ArrowRight: () => moveBy(step, 0),
      ArrowUp: () => moveBy(0, step), ArrowDown: () => moveBy(0, -step),
      q: () => turnBy(turn), e: () => turnBy(-turn),
      '+': () => scaleBy(1.005), '=': () => scaleBy(1.005), '-': () => scaleBy(1 / 1.005),
      '[': () => setBlend(blend - 0.1), ']': () => setBlend(blend + 0.1),
      b: () => setBlend(blend < 0.5 ? 1 : 0), r: reset, f: showAll,
    };
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });

  $('blend').addEventListener('input', () => setBlend($('blend').value / 100));
  $('turn').addEventListener('input', () => turnBy($('turn').value - pose.deg));
  $('scale').addEventListener('input', () => scaleBy(2 ** $('scale').value / pose.scale));
  for (const [id, key] of [['x', 'x'], ['y', 'y'], ['deg', 'deg'], ['s', 'scale']])
    $(id).addEventListener('change', () => {
      const value = $(id).valueAsNumber;
      if (Number.isFinite(value) && (key !== 'scale' || (value >= 0.1 && value <= 10))) pose[key] = value;
      changed();
    });
  $('start').addEventListener('click', reset);
  $('unit').addEventListener('click', () => scaleBy(1 / pose.scale));
  $('fit').addEventListener('click', showAll);
  addEventListener('resize', redraw);

  for (const image of document.querySelectorAll('figure img'))
    image.addEventListener('click', () => image.classList.toggle('large'));
  $('map-name').textContent = data.map.name;
  $('truth-name').textContent = data.truth.name;
  fit();
  showPose();
  draw();
  measure();
  document.body.dataset.ready = 'yes';
})();
