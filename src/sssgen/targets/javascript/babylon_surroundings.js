// The light of the surroundings for a body that it comes through: Babylon's hemispheric lights, its ambient colour and its
// environment, as the light of a white matte surface that faces a direction of the world.

import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';

/** For red, green and blue: xyz is what a component of the direction adds, w what all directions have. */
export const SKY = ['sss_sky_red', 'sss_sky_green', 'sss_sky_blue'];

const LANGUAGES = [
  { head: 'vec3 sss_surroundings(vec3 direction)', vec3: 'vec3', vec4: 'vec4', variable: (type) => type, uniform: '' },
  {
    head: 'fn sss_surroundings(direction: vec3f) -> vec3f', vec3: 'vec3f', vec4: 'vec4f', variable: () => 'var', uniform: 'uniforms.',
  },
];

/** The function in GLSL and in WGSL. */
export const SURROUNDINGS = LANGUAGES.map(({ head, vec3, vec4, variable, uniform }) => `
${head} {
${variable(vec4)} facing = ${vec4}(direction, 1.0);
${variable(vec3)} light = ${vec3}(${SKY.map((name) => `dot(${uniform}${name}, facing)`).join(', ')}) + ${uniform}vAmbientColor;
#if defined(REFLECTION) && defined(USESPHERICALFROMREFLECTIONMAP)
${variable(vec3)} sought = (${uniform}reflectionMatrix * ${vec4}(direction, 0.0)).xyz;
#ifdef REFLECTIONMAP_OPPOSITEZ
sought.z = -sought.z;
#endif
#ifdef INVERTCUBICMAP
sought.y = -sought.y;
#endif
light += computeEnvironmentIrradiance(sought) * ${uniform}vReflectionColor.rgb * ${uniform}vReflectionInfos.x * ${uniform}vLightingIntensity.z;
#endif
return max(light, ${vec3}(0.0));
}
`);

/** The values of SKY for a mesh: the sum of the hemispheric lights that shine on it, four numbers each. */
export function skyOf(mesh) {
  const sky = SKY.map(() => [0, 0, 0, 0]);
  for (const light of mesh.lightSources) {
    if (light.getClassName() !== 'HemisphericLight') continue;
    const above = light.diffuse.asArray(), below = light.groundColor.asArray(), up = light.direction.normalizeToNew().asArray();
    sky.forEach((row, channel) => {
      const half = 0.5 * light.getScaledIntensity();
      up.forEach((part, axis) => { row[axis] += half * (above[channel] - below[channel]) * part; });
      row[3] += half * (above[channel] + below[channel]);
    });
  }
  return sky;
}

/** The terms of Babylon's polynomial of the light from an environment, by their names there. @param {Vector3} way */
const termsOf = ({ x, y, z }) => Object.entries({ x, y, z, xx: x * x, yy: y * y, zz: z * z, xy: x * y, yz: y * z, zx: z * x });

/** The environment of a material, as `sss_surroundings` has it: a function from a direction to a colour. */
function environmentOf(material, scene) {
  const texture = material.reflectionTexture ?? scene.environmentTexture, around = texture?.sphericalPolynomial;
  if (!around) return () => Vector3.Zero();
  const turn = texture.getReflectionTextureMatrix(), sides = Vector3.One();
  if (texture.isCube && scene.useRightHandedSystem ? !texture.invertZ : texture.invertZ) sides.z = -1;
  if (texture.coordinatesMode === Texture.INVCUBIC_MODE) sides.y = -1;
  const strength = texture.level * scene.iblIntensity * material.environmentIntensity * scene.environmentIntensity;
  const tint = Vector3.FromArray(material.reflectionColor.asArray()).scale(strength);
  return (way) => {
    const light = Vector3.Zero();
    for (const [name, value] of termsOf(Vector3.TransformNormal(way, turn).multiply(sides))) light.addInPlace(around[name].scale(value));
    return light.multiply(tint);
  };
}

/** The same on the CPU for a mesh with a material: a function from a direction of the world to a colour. */
export function shownAround(mesh, material) {
  const scene = mesh.getScene(), sky = skyOf(mesh);
  const environment = environmentOf(material, scene), ambient = scene.ambientColor.multiply(material.ambientColor).asArray();
  return (way) => {
    const facing = [...way.asArray(), 1], beyond = environment(way).asArray();
    return ambient.map((value, channel) => (
      Math.max(value + beyond[channel] + sky[channel].reduce((sum, part, index) => sum + part * facing[index], 0), 0)
    ));
  };
}
