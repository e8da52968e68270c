// The time of the light inside a body in JavaScript, as a page computes it when a light has moved:
//
//   node benchmarks/inner_light.mjs wax.bin        # of sssgen bake fluence SCENE --relit 16 -o wax.bin
//
// The best of many runs, for lights whose direction is that of the whole body, for lights near to it, and for surroundings; then the same
// for a body that bones bend, of VERTICES vertices and BONES bones.

import { readFileSync } from 'node:fs';
import { argv } from 'node:process';
import { responseOf } from '../src/sssgen/targets/javascript/inner_light.js';
import { InnerPose } from '../src/sssgen/targets/javascript/inner_pose.js';

const RUNS = 100, VERTICES = 20000, BONES = 60;

const [, , file] = argv;
const response = await responseOf({ data: readFileSync(file), facts: JSON.parse(readFileSync(`${file}.json`, 'utf8')) });
const middle = response.low.map((low, axis) => 0.5 * (low + response.high[axis]));
const distant = { directional: true, place: [0.48, 0.6, 0.64], colorAt: () => [1, 1, 1] };
const near = { directional: false, place: middle.map((value) => value + 2), colorAt: (place) => place.map((value) => 1 / (1 + value * value)) };
const around = Array.from({ length: 9 }, (_, harmonic) => [1 / (1 + harmonic), 0.5, 0.2]);
const texels = new Uint16Array(4 * response.width * response.height * response.depth);

const timeOf = (work) => {
  const start = performance.now();
  work();
  return performance.now() - start;
};
const bestOf = (work) => Math.min(...Array.from({ length: RUNS }, () => timeOf(work)));
const best = (lights, surroundings, pose = null) => bestOf(() => response.light(lights, surroundings, texels, pose));
const writing = best([], null);
console.log(`${response.count} voxels, ${response.rank} numbers in each; to half floats ${writing.toFixed(2)} ms`);
const KINDS = [['a distant light', [distant], null], ['a light near the body', [near], null], ['surroundings', [], around]];
for (const [name, lights, surroundings] of KINDS) {
  console.log(`${name}: ${(best(lights, surroundings) - writing).toFixed(2)} ms`);
}

// points of Fibonacci's sphere in the box, each with two bones, by its height
const vertices = Float32Array.from({ length: 3 * VERTICES }, (_, at) => {
  const index = Math.floor(at / 3), y = 1 - (2 * index + 1) / VERTICES, angle = index * Math.PI * (3 - Math.sqrt(5)), across = Math.sqrt(1 - y * y);
  return middle[at % 3] + 0.5 * response.size[at % 3] * [across * Math.cos(angle), y, across * Math.sin(angle)][at % 3];
});
const bones = Float32Array.from({ length: 4 * VERTICES }, (_, at) => Math.min(Math.floor((at / 4 / VERTICES) * BONES) + Number(at % 4 === 1), BONES - 1));
const weights = Float32Array.from({ length: 4 * VERTICES }, (_, at) => [0.6, 0.4, 0, 0][at % 4]);
let pose, turn = 0;
console.log(`a bent body, once: ${timeOf(() => (pose = new InnerPose(response, vertices, bones, weights))).toFixed(2)} ms`);
const bend = () => {
  turn += 0.01;
  pose.bend(Array.from({ length: BONES }, (_, bone) => {
    const cosine = Math.cos(turn * bone), sine = Math.sin(turn * bone);
    return [cosine, sine, 0, 0, -sine, cosine, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  }));
};
console.log(`bent, the bones: ${bestOf(bend).toFixed(2)} ms`);
for (const [name, lights, surroundings] of KINDS) {
  console.log(`bent, ${name}: ${(best(lights, surroundings, pose) - writing).toFixed(2)} ms`);
}
