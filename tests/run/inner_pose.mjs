// The light inside a body whose bones turn all of it, and which points are nearest to others: of what comes in, as JSON.

import { readFileSync } from 'node:fs';
import { argv } from 'node:process';

const [, , runtime, file] = argv;
const { responseOf } = await import(`${runtime}/inner_light.js`);
const { InnerPose, nearestOf } = await import(`${runtime}/inner_pose.js`);
const { surroundings, matrix, places, others } = JSON.parse(readFileSync(0, 'utf8'));

const response = await responseOf({ data: readFileSync(file), facts: JSON.parse(readFileSync(`${file}.json`, 'utf8')) });
const vertices = Float32Array.from(others.flat()), count = others.length;
const pose = new InnerPose(response, vertices, new Float32Array(4 * count), Float32Array.from({ length: 4 * count }, (_, at) => Number(at % 4 === 0)));
pose.bend([matrix]);
const texels = new Uint16Array(4 * response.width * response.height * response.depth);
response.light([], surroundings, texels, pose);
console.log(JSON.stringify({ texels: Array.from(texels), nearest: nearestOf(places, vertices) }));
