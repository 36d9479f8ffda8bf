'use strict';
// The figures of the C++ program (psi.cpp, overlap.cpp, resample.cpp) for one pose of the map.
// A grid is {w, h, res, x0, y0, half, cells}: row 0 in the south, cells 0 unknown, 1 free, 2 occupied.
// A pose is {x, y, deg, scale}: p_truth = R(deg) * scale * p_map + (x, y).
const Metric = (() => {
  const UNKNOWN = 0, FREE = 1, OCCUPIED = 2;
  const MARGIN = 1.0;  // unknown cells around both maps when psi is taken [m]

  /** Bytes of class * 64 + run length - 1, row by row. */
  function decode(packed) {
    const bytes = Uint8Array.from(atob(packed.runs), (c) => c.charCodeAt(0));
    const cells = new Uint8Array(packed.w * packed.h);
    let at = 0;
    for (const byte of bytes) {
      const length = (byte & 63) + 1;
      cells.fill(byte >> 6, at, at + length);
      at += length;
    }
    return {...packed, cells};
  }

  function scaled(grid, s) {
    return {...grid, res: grid.res * s, x0: grid.x0 * s, y0: grid.y0 * s, half: grid.half * s};
  }

  /** Squared distances along one line: lower envelope of parabolas (Felzenszwalb and Huttenlocher 2012). */
  function envelope(f, n, out, v, z) {
    let k = -1;
    for (let q = 0; q < n; ++q) {
      if (f[q] === Infinity) continue;
      let s = -Infinity;
      while (k >= 0) {
        s = (f[q] + q * q - f[v[k]] - v[k] * v[k]) / (2 * (q - v[k]));
        if (s > z[k]) break;
        --k;
      }
      if (k < 0) s = -Infinity;
      v[++k] = q;
      z[k] = s;
      z[k + 1] = Infinity;
    }
    if (k < 0) return out.fill(Infinity, 0, n);
    for (let q = 0, i = 0; q < n; ++q) {
      while (z[i + 1] < q) ++i;
      out[q] = (q - v[i]) * (q - v[i]) + f[v[i]];
    }
    return out;
  }

  /** Distance to the nearest wall [cells] over the walls' box and `margin` cells around it. */
  function wallField(grid, margin) {
    let x1 = grid.w, y1 = grid.h, x2 = -1, y2 = -1;
    for (let y = 0, i = 0; y < grid.h; ++y)
      for (let x = 0; x < grid.w; ++x, ++i)
        if (grid.cells[i] === OCCUPIED) {
          x1 = Math.min(x1, x); x2 = Math.max(x2, x);
          y1 = Math.min(y1, y); y2 = Math.max(y2, y);
        }
    if (x2 < 0) return null;
    const w = x2 - x1 + 1 + 2 * margin, h = y2 - y1 + 1 + 2 * margin;
    const d = new Float64Array(w * h).fill(Infinity);
    for (let y = y1; y <= y2; ++y)
      for (let x = x1; x <= x2; ++x)
        if (grid.cells[y * grid.w + x] === OCCUPIED) d[(y - y1 + margin) * w + x - x1 + margin] = 0;
    const n = Math.max(w, h);
    const f = new Float64Array(n), out = new Float64Array(n), z = new Float64Array(n + 1), v = new Int32Array(n);
    for (let x = 0; x < w; ++x) {
      for (let y = 0; y < h; ++y) f[y] = d[y * w + x];
      envelope(f, h, out, v, z);
      for (let y = 0; y < h; ++y) d[y * w + x] = out[y];
    }
    for (let y = 0; y < h; ++y) {
      for (let x = 0; x < w; ++x) f[x] = d[y * w + x];
      envelope(f, w, out, v, z);
      for (let x = 0; x < w; ++x) d[y * w + x] = Math.sqrt(out[x]);
    }
    return {w, h, d, margin, dx: x1 - margin, dy: y1 - margin};
  }

  /** Distance from (x, y) [m] to the nearest wall of `grid`, bilinear, at most `cap` [m]. */
  function distance(field, grid, x, y, cap) {
    if (!field) return cap;
    const u = (x - grid.x0) / grid.res - field.dx - 0.5, v = (y - grid.y0) / grid.res - field.dy - 0.5;
    if (!(u >= 0 && v >= 0 && u < field.w - 1 && v < field.h - 1)) return cap;
    const i = Math.floor(u), j = Math.floor(v), at = j * field.w + i, r = grid.res, d = field.d;
    const s0 = Math.min(cap, d[at] * r), s1 = Math.min(cap, d[at + 1] * r);
    const n0 = Math.min(cap, d[at + field.w] * r), n1 = Math.min(cap, d[at + field.w + 1] * r);
    const a = s0 + (u - i) * (s1 - s0), b = n0 + (u - i) * (n1 - n0);
    return a + (v - j) * (b - a);
  }

  function rigid(pose) {
    const phi = pose.deg * Math.PI / 180, c = Math.cos(phi), s = Math.sin(phi);
    return {
      c, s,
      forward: (x, y) => [pose.x + c * x - s * y, pose.y + s * x + c * y],
      inverse: (x, y) => [c * (x - pose.x) + s * (y - pose.y), -s * (x - pose.x) + c * (y - pose.y)],
    };
  }

  function overlap(map, truth, fields, T, tau) {
    const excess = map.half - truth.half;
    const kernel = (d) => Math.min(1, Math.max(0, 1 - d / tau));
    let sum = 0, count = 0;
    for (let y = 0, i = 0; y < map.h; ++y)
      for (let x = 0; x < map.w; ++x, ++i) {
        if (map.cells[i] !== OCCUPIED) continue;
        const [px, py] = T.forward(map.x0 + (x + 0.5) * map.res, map.y0 + (y + 0.5) * map.res);
        const cx = Math.floor((px - truth.x0) / truth.res), cy = Math.floor((py - truth.y0) / truth.res);
        if (cx < 0 || cy < 0 || cx >= truth.w || cy >= truth.h) continue;
        if (truth.cells[cy * truth.w + cx] === UNKNOWN) continue;
        const d = distance(fields.truth, truth, px, py, tau + truth.res) - 0.5 * truth.res;
        sum += kernel(Math.max(0, d) + Math.max(0, -excess));
        ++count;
      }
    const precision = count > 0 ? sum / count : 0;
    sum = count = 0;
    for (let y = 0, i = 0; y < truth.h; ++y)
      for (let x = 0; x < truth.w; ++x, ++i) {
        if (truth.cells[i] !== OCCUPIED) continue;
        const [px, py] = T.inverse(truth.x0 + (x + 0.5) * truth.res, truth.y0 + (y + 0.5) * truth.res);
        const d = distance(fields.map, map, px, py, tau + map.res) - 0.5 * map.res;
        sum += kernel(Math.max(0, d) + Math.max(0, excess));
        ++count;
      }
    const recall = count > 0 ? sum / count : 0;
    return {precision, recall, overlap: Math.min(precision, recall)};
  }

  /** The frame on the truth's lattice that holds what both maps know. */
  function commonFrame(map, truth, T) {
    let x1 = truth.w, y1 = truth.h, x2 = -1, y2 = -1;
    const take = (x, y) => {
      x1 = Math.min(x1, x); x2 = Math.max(x2, x);
      y1 = Math.min(y1, y); y2 = Math.max(y2, y);
    };
    for (let y = 0; y < truth.h; ++y)
      for (let x = 0; x < truth.w; ++x)
        if (truth.cells[y * truth.w + x] !== UNKNOWN) take(x, y);
    for (let y = 0; y < map.h; ++y) {
      const row = map.cells.subarray(y * map.w, (y + 1) * map.w);
      const first = row.findIndex((c) => c !== UNKNOWN);
      if (first < 0) continue;
      let last = map.w - 1;
      while (row[last] === UNKNOWN) --last;
      for (const x of [first, last]) {
        const [px, py] = T.forward(map.x0 + (x + 0.5) * map.res, map.y0 + (y + 0.5) * map.res);
        take(Math.floor((px - truth.x0) / truth.res), Math.floor((py - truth.y0) / truth.res));
      }
    }
    if (x2 < 0) return {w: truth.w, h: truth.h, res: truth.res, x0: truth.x0, y0: truth.y0};
    const m = Math.ceil(MARGIN / truth.res);
    return {w: x2 - x1 + 1 + 2 * m, h: y2 - y1 + 1 + 2 * m, res: truth.res,
            x0: truth.x0 + (x1 - m) * truth.res, y0: truth.y0 + (y1 - m) * truth.res};
  }

  function resample(grid, T, frame) {
    const out = new Uint8Array(frame.w * frame.h), step = frame.res / grid.res;
    for (let y = 0; y < frame.h; ++y) {
      const [fx, fy] = T.inverse(frame.x0 + 0.5 * frame.res, frame.y0 + (y + 0.5) * frame.res);
      const u = (fx - grid.x0) / grid.res, v = (fy - grid.y0) / grid.res;
      for (let x = 0; x < frame.w; ++x) {
        const i = Math.floor(u + T.c * step * x), j = Math.floor(v - T.s * step * x);
        if (i >= 0 && j >= 0 && i < grid.w && j < grid.h) out[y * frame.w + x] = grid.cells[j * grid.w + i];
      }
    }
    if (grid.res > 0.9 * frame.res) return out;
    for (let y = 0, k = 0; y < grid.h; ++y)
      for (let x = 0; x < grid.w; ++x, ++k) {
        if (grid.cells[k] !== OCCUPIED) continue;
        const [px, py] = T.forward(grid.x0 + (x + 0.5) * grid.res, grid.y0 + (y + 0.5) * grid.res);
        const i = Math.floor((px - frame.x0) / frame.res), j = Math.floor((py - frame.y0) / frame.res);
        if (i >= 0 && j >= 0 && i < frame.w && j < frame.h) out[j * frame.w + i] = OCCUPIED;
      }
    return out;
  }

  /** Eq. (6): mean Manhattan distance [cells] from the cells of `colour` in `from` to the nearest in `to`. */
  function meanDistance(from, to, colour, w, h) {
    const d = new Int32Array(w * h), far = w + h;
    for (let y = 0, i = 0; y < h; ++y)
      for (let x = 0; x < w; ++x, ++i) {
        let best = far;
        if (to[i] === colour) best = 0;
        else {
          if (x > 0) best = Math.min(best, d[i - 1] + 1);
          if (y > 0) best = Math.min(best, d[i - w] + 1);
        }
        d[i] = best;
      }
    let sum = 0, count = 0;
    for (let y = h - 1, i = w * h - 1; y >= 0; --y)
      for (let x = w - 1; x >= 0; --x, --i) {
        if (x < w - 1 && d[i + 1] + 1 < d[i]) d[i] = d[i + 1] + 1;
        if (y < h - 1 && d[i + w] + 1 < d[i]) d[i] = d[i + w] + 1;
        if (from[i] === colour) {
          sum += d[i];
          ++count;
        }
      }
    return sum / count;
  }

  function psi(a, b, frame, cap) {
    const of = (colour) => {
      const inA = a.includes(colour), inB = b.includes(colour);
      if (!inA && !inB) return [0, 0];
      if (!inA || !inB) return [cap, cap];
      return [meanDistance(a, b, colour, frame.w, frame.h) * frame.res,
              meanDistance(b, a, colour, frame.w, frame.h) * frame.res];
    };
    const occupied = of(OCCUPIED), free = of(FREE), unknown = of(UNKNOWN);
    const sum = (pair) => pair[0] + pair[1];
    return {
      psi_m: 0.25 * (sum(occupied) + sum(free)),
      psi_literal_m: sum(occupied) + sum(free) + sum(unknown),
      psi_occupied_map_m: occupied[0],
      psi_occupied_truth_m: occupied[1],
    };
  }

  const IDENTITY = rigid({x: 0, y: 0, deg: 0});

  /** Everything the page shows for one pose. */
  function figures(data, pose) {
    const map = scaled(data.map, pose.scale), truth = data.truth, T = rigid(pose);
    const reach = (grid) => Math.ceil((data.tau + grid.res) / grid.res) + 1;
    const field = (key, grid) => {
      const known = data.fields[key];
      if (known === undefined || (known && known.margin < reach(grid))) data.fields[key] = wallField(grid, reach(grid));
      return data.fields[key];
    };
    const fields = {map: field('map', map), truth: field('truth', truth)};
    const frame = commonFrame(map, truth, T);
    const a = resample(map, T, frame), b = resample(truth, IDENTITY, frame);
    let known = 0, total = 0;
    for (let i = 0; i < b.length; ++i)
      if (b[i] !== UNKNOWN) {
        ++total;
        if (a[i] !== UNKNOWN) ++known;
      }
    return {...overlap(map, truth, fields, T, data.tau), ...psi(a, b, frame, data.cap),
            known: total > 0 ? known / total : 0};
  }

  return {decode, figures, rigid};
})();
