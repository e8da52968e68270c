// The look of a medium, its colour and depth, and the albedo and extinction that follow: as material/scatter_color.py
// and material/medium_look.py have it, so that a control answers at once. A test compares both.

export const DEPTHS = [1e-4, 100];  // of a depth, in world units

/** The root of the absorbed share of a medium with that colour.
 * @param {number} color */
const absorbingRoot = (color) => 4.09712 + 4.20863 * color - Math.sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);

/** The single-scattering albedo of a thick medium that reflects that share of diffuse light.
 * @param {number} color */
export const albedoOf = (color) => Math.min(Math.max(1 - absorbingRoot(Math.min(Math.max(color, 0), 1)) ** 2, 0), 1);

/** The colour for which `albedoOf` gives that albedo.
 * @param {number} albedo */
export function colorOf(albedo) {
  let [low, high] = [0, 1];
  for (let round = 0; round < 50; round++) {
    const middle = (low + high) / 2;
    if (albedoOf(middle) < albedo) low = middle; else high = middle;
  }
  return (low + high) / 2;
}

/** The mean free path for an extinction, and the reverse.
 * @param {number} number */
export const inverse = (number) => Math.min(Math.max(1 / Math.max(number, 1e-9), DEPTHS[0]), 1 / DEPTHS[0]);

/** The depth for an extinction.
 * @param {number} extinction */
export const depthOf = (extinction) => Math.min(inverse(extinction), DEPTHS[1]);

/** The mean free path of a stage, which follows from a depth: 1 over the mean extinction.
 * @param {number[]} depth */
export const meanFreePath = (depth) => depth.length / depth.reduce((sum, length) => sum + 1 / length, 0);

/** The absorption and the scattering of an extinction and an albedo, per channel.
 * @param {number[]} extinction @param {number[]} albedo */
export function coefficients(extinction, albedo) {
  const scattering = extinction.map((part, index) => part * albedo[index]);
  return { absorption: extinction.map((part, index) => part - scattering[index]), scattering };
}
