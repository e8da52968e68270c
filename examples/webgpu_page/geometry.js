// Meshes and a camera: what a page has of its own.

import { LAYOUT } from './material.js';

export const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** A unit sphere; u goes once around from the back, v from the south pole up. */
export function sphere(device, rows = 64, columns = 128) {
  const vertices = [], triangles = [];
  for (let row = 0; row <= rows; row++) {
    for (let column = 0; column <= columns; column++) {
      const u = column / columns, v = row / rows, turn = 2 * Math.PI * (u - 0.5), tilt = Math.PI * (v - 0.5);
      const normal = [Math.cos(tilt) * Math.sin(turn), Math.sin(tilt), Math.cos(tilt) * Math.cos(turn)];
      vertices.push(...normal, ...normal, Math.cos(turn), 0, -Math.sin(turn), 1, u, v);
      const a = row * (columns + 1) + column, b = a + columns + 1;
      if (row < rows && column < columns) triangles.push(a, a + 1, b, b, a + 1, b + 1);
    }
  }
  return mesh(device, new Float32Array(vertices), new Uint32Array(triangles), [[-1, -1, -1], [1, 1, 1]]);
}

/** A body for the material and its passes: where it is, and the lowest and the highest corner of its own box. */
export function mesh(device, vertices, triangles, box, model = identity) {
  const filled = (data, usage) => {
    const buffer = device.createBuffer({ size: data.byteLength, usage: usage | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(buffer, 0, data);
    return buffer;
  };
  return {
    layout: LAYOUT,
    buffers: [filled(vertices, GPUBufferUsage.VERTEX)],
    triangles: filled(triangles, GPUBufferUsage.INDEX),
    count: triangles.length,
    box,
    model,
  };
}

/** A camera that looks at `target`, with +y up: world to clip space, and back, column by column. */
export function camera(position, target, aspect, degrees = 40, near = 0.1, far = 100) {
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const unit = (v) => v.map((part) => part / Math.hypot(...v));
  const back = unit(position.map((part, axis) => part - target[axis]));
  const side = unit([back[2], 0, -back[0]]);
  const up = [0, 1, 2].map((axis) => back[(axis + 1) % 3] * side[(axis + 2) % 3] - back[(axis + 2) % 3] * side[(axis + 1) % 3]);
  const y = 1 / Math.tan((degrees * Math.PI) / 360), x = y / aspect;
  const a = far / (near - far), b = a * near;
  const column = (axis) => [x * side[axis], y * up[axis], a * back[axis], -back[axis]];
  const [right, above, behind] = [side, up, back].map((way) => -dot(way, position));
  return {
    position,
    viewProjection: [...column(0), ...column(1), ...column(2), x * right, y * above, a * behind + b, -behind],
    inverseViewProjection: [
      ...side.map((part) => part / x), 0, ...up.map((part) => part / y), 0, ...position.map((part) => part / b), 1 / b,
      ...position.map((part, axis) => (part * a) / b - back[axis]), a / b,
    ],
  };
}
