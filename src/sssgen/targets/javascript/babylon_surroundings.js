// The light of the surroundings for a body that it comes through: Babylon's hemispheric lights, its ambient colour and its
// environment, as the light of a white matte surface that faces a direction of the world.

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
