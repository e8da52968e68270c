// The time of the light inside a body in JavaScript, as a page computes it when a light has moved:
//
//   node benchmarks/inner_light.mjs wax.bin        # of sssgen bake fluence SCENE --relit 16 -o wax.bin
//
// The best of many runs, for lights whose direction is that of the whole body, for lights near to it, and for surroundings.

import { readFileSync } from 'node:fs';
import { argv } from 'node:process';
import { responseOf } from '../src/sssgen/targets/javascript/inner_light.js';

const RUNS = 100;

const [, , file] = argv;
const response = await responseOf({ data: readFileSync(file), facts: JSON.parse(readFileSync(`${file}.json`, 'utf8')) });
const middle = response.low.map((low, axis) => 0.5 * (low + response.high[axis]));
const distant = { directional: true, place: [0.48, 0.6, 0.64], colorAt: () => [1, 1, 1] };
const near = { directional: false, place: middle.map((value) => value + 2), colorAt: (place) => place.map((value) => 1 / (1 + value * value)) };
const around = Array.from({ length: 9 }, (_, harmonic) => [1 / (1 + harmonic), 0.5, 0.2]);
const texels = new Uint16Array(4 * response.width * response.height * response.depth);

const best = (lights, surroundings) => {
  const times = Array.from({ length: RUNS }, () => {
    const start = performance.now();
    response.light(lights, surroundings, texels);
    return performance.now() - start;
  });
  return Math.min(...times);
};
const writing = best([], null);
console.log(`${response.count} voxels, ${response.rank} numbers in each; to half floats ${writing.toFixed(2)} ms`);
for (const [name, lights, surroundings] of [['a distant light', [distant], null], ['a light near the body', [near], null], ['surroundings', [], around]]) {
  console.log(`${name}: ${(best(lights, surroundings) - writing).toFixed(2)} ms`);
}
