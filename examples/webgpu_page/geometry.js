// A sphere and a camera: what a page has of its own.

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

/** A camera at `distance` that looks down -z at the origin: world to clip space, and back, column by column. */
export function camera(distance, aspect, degrees = 40, near = 0.1, far = 100) {
  const y = 1 / Math.tan((degrees * Math.PI) / 360), x = y / aspect;
  const a = far / (near - far), b = a * near;
  return {
    position: [0, 0, distance],
    viewProjection: [x, 0, 0, 0, 0, y, 0, 0, 0, 0, a, -1, 0, 0, b - a * distance, distance],
    inverseViewProjection: [1 / x, 0, 0, 0, 0, 1 / y, 0, 0, 0, 0, distance / b, 1 / b, 0, 0, -1 + (a * distance) / b, a / b],
  };
}
