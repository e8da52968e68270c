// The shadow of the light that comes through a body. A point that is lit from behind lies in the shadow of its own body, so
// the shadow is read where the light entered a box around the body: there only other objects shadow it.

import * as CLASSIC from 'three';
import * as TSL from 'three/tsl';

// WebGLRenderer: each shadow that three's shader reads at the surface is read at the entry, too.

/** Varyings of the surface in the arguments of three's shadows, and the matrices that they come from. */
const MATRICES = {
  vPointShadowCoord: 'pointShadowMatrix', vSpotLightCoord: 'spotLightMatrix', vDirectionalShadowCoord: 'directionalShadowMatrix',
};

/** The entry, for the lines in three's loops over its lights; only the vertex shader declares the matrices. */
export const entryFunction = (statements) => /* glsl */ `
#ifdef USE_SHADOWMAP
#if NUM_POINT_LIGHT_SHADOWS > 0
uniform mat4 pointShadowMatrix[NUM_POINT_LIGHT_SHADOWS];
#endif
#if NUM_DIR_LIGHT_SHADOWS > 0
uniform mat4 directionalShadowMatrix[NUM_DIR_LIGHT_SHADOWS];
#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
uniform mat4 spotLightMatrix[NUM_SPOT_LIGHT_COORDS];
#endif
vec3 sss_sun_shift = vec3(0.0);

vec4 sss_entry(const in IncidentLight directLight) {
${statements}}
`;

/**
 * three's chunks of the fragment shader, with the shadows at the entry.
 * @param {string} name the material's
 */
export function entryChunks(name) {
  let { lights_fragment_begin: lights, shadowmap_pars_fragment: shadows } = CLASSIC.ShaderChunk;
  const replaced = (text, pattern, by) => {
    if (!pattern.test(text)) throw new Error(`${name}: this version of three.js has no ${pattern.source} in its shader`);
    return text.replace(pattern, by);
  };
  for (const [coordinate, matrix] of Object.entries(MATRICES)) {
    const line = new RegExp(`directLight\\.color \\*= (.*)${coordinate}\\[ i \\](.*;)`);
    lights = replaced(lights, line, (whole, before, after) => (
      `sss_light_color *= ${before}${matrix}[ i ] * sss_entry(directLight)${after}\n${whole}`
    ));
  }
  if (lights.includes('getSunShadow')) { // it reads the varying itself
    shadows = replaced(shadows, /vSunShadowWorldPosition\.xyz/, '(vSunShadowWorldPosition.xyz + sss_sun_shift)');
    lights = replaced(lights, /directLight\.color \*= (.*getSunShadow\(.*;)/, (whole, shadow) => `
sss_sun_shift = sss_entry(directLight).xyz - vSunShadowWorldPosition.xyz;
sss_light_color *= ${shadow}
sss_sun_shift = vec3(0.0);
${whole}`);
  }
  return { lights_fragment_begin: lights, shadowmap_pars_fragment: shadows };
}

// WebGPURenderer: the shadow of a light is a node, whose map is read a second time.

/** Whether a light has a shadow on the object, of a kind that can be read elsewhere: cascades and tiles cannot. */
export function hasEntryShadow({ colorNode, baseColorNode, shadowNode }) {
  return baseColorNode && colorNode !== baseColorNode && ['ShadowNode', 'PointShadowNode'].includes(shadowNode.type);
}

/** The function way_out_of_box of the texts, in nodes. */
function wayOutOfBox(at, towards, low, high) {
  const side = TSL.mix(at.sub(low), high.sub(at), TSL.step(0, towards));
  /** @type {any} */
  const ways = side.max(0).div(towards.abs().max(1e-12));
  return ways.x.min(ways.y).min(ways.z);
}

/**
 * The share of a light that other objects leave to the body.
 * @param {any} lightNode three's node of the light
 * @param {{ L: any, nearness: any, worldToBody: any, box: Record<string, any> }} values nodes; `box` are the uniforms
 */
export const entryShadow = (lightNode, { L, nearness, worldToBody, box }) => TSL.Fn((_, builder) => {
  const { light, shadowNode } = lightNode, at = worldToBody.mul(TSL.vec4(TSL.positionWorld, 1)).xyz;
  const way = wayOutOfBox(at, worldToBody.mul(TSL.vec4(L, 0)).xyz, box.bodyMin, box.bodyMax);
  const entry = TSL.vec4(TSL.positionWorld.add(L.mul(way.min(TSL.float(0.99).div(nearness.max(1e-30))))), 1);
  shadowNode.build(builder); // which makes its map
  const { shadow, shadowMap, vsmShadowMapHorizontal: moments } = shadowNode;
  const lit = shadowNode.setupShadowFilter(builder, {
    filterFn: shadow.filterNode ?? shadowNode.getShadowFilterFn(builder.renderer.shadowMap.type),
    depthTexture: moments ? moments.texture : shadowMap.depthTexture,
    shadowCoord: shadowNode.setupShadowCoord(builder, TSL.lightShadowMatrix(light).mul(entry)),
    depthLayer: shadowNode.depthLayer,
    shadow,
  });
  return TSL.mix(1, lit, TSL.reference('intensity', 'float', shadow).setGroup(TSL.renderGroup));
}, 'float')();
