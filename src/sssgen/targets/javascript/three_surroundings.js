// The light of the surroundings for a body that it comes through: three's ambient and hemisphere lights, light probes and
// environment, as the light of a white matte surface that faces a direction of the world.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';

/** The function for the fragment shader of WebGLRenderer, which three's own functions stand before. */
export const SURROUNDINGS = /* glsl */ `
vec3 sss_surroundings(vec3 direction) {
  vec3 facing = mat3(viewMatrix) * direction;
  vec3 light = ambientLightColor;
#if defined(USE_LIGHT_PROBES)
  light += getLightProbeIrradiance(lightProbe, facing);
#endif
#if (NUM_HEMI_LIGHTS > 0)
#pragma unroll_loop_start
  for (int i = 0; i < NUM_HEMI_LIGHTS; i ++) {
    light += getHemisphereLightIrradiance(hemisphereLights[i], facing);
  }
#pragma unroll_loop_end
#endif
#if defined(USE_ENVMAP)
  light += getIBLIrradiance(facing);
#endif
  return max(light, 0.0) * RECIPROCAL_PI;
}
`;

/**
 * A value of a light, which a page may change at any time.
 * @returns {any} a node
 */
const ofLight = (value, update) => TSL.uniform(value).onRenderUpdate((_, self) => update(self.value));

/** What a light of the surroundings gives to a surface that faces a direction of the world; null for other lights. */
function lightOf(light, direction) {
  /** @returns {any} three's types know no uniform of a colour */
  const color = (name) => ofLight(new THREE.Color(), (value) => value.copy(light[name]).multiplyScalar(light.intensity));
  if (light.isAmbientLight) return color('color');
  if (light.isHemisphereLight) {
    const up = ofLight(new THREE.Vector3(), (value) => value.setFromMatrixPosition(light.matrixWorld).normalize());
    return TSL.mix(color('groundColor'), color('color'), up.dot(direction).mul(0.5).add(0.5));
  }
  if (!light.isLightProbe) return null;
  /** @type {any} */
  const harmonics = TSL.uniformArray(Array.from({ length: 9 }, () => new THREE.Vector3()));
  harmonics.onRenderUpdate((_, { array }) => {
    array.forEach((value, index) => value.copy(light.sh.coefficients[index]).multiplyScalar(light.intensity));
  });
  return TSL.getShIrradianceAt(direction, harmonics);
}

/** The node with the same for WebGPURenderer. */
export function surroundings(direction) {
  return TSL.Fn((_, builder) => {
    const lights = (builder.lightsNode?.getLights() ?? []).map((light) => lightOf(light, direction));
    const picture = builder.material.envNode ?? builder.environmentNode;
    if (picture) {
      const filtered = picture.isTextureNode ? TSL.pmremTexture(picture.value) : picture;
      const seen = filtered.context({ getUV: () => direction, getTextureLevel: () => TSL.float(1) });
      lights.push(seen.mul(Math.PI).mul(TSL.materialEnvIntensity));
    }
    return lights.filter(Boolean).reduce((sum, light) => sum.add(light), TSL.vec3(0)).max(0).mul(1 / Math.PI);
  }, 'vec3')();
}
