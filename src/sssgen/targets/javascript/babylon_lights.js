// The lights of Babylon.js, as what is drawn or computed before a material takes them.

import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';

export const POINT = 0, DIRECTIONAL = 1, SPOT = 2, RECTANGLE = 4;

/** Against the direction in which a light shines. */
export const axisOf = (light) => (light.computeTransformedInformation() ? light.transformedDirection : light.direction).scale(-1).normalize();

/** The position of a light, or the direction towards it, as a vector of Babylon. */
function placeOf(light) {
  if (light.getTypeID() === DIRECTIONAL) return axisOf(light);
  if (light.getTypeID() !== RECTANGLE) return light.getAbsolutePosition();
  return light.parent ? Vector3.TransformCoordinates(light.position, light.parent.getWorldMatrix()) : light.position;
}

/** The same as a homogeneous vector; and the light's radiance. */
export function lightOf(light) {
  if (!light) return [[0, 1, 0, 0], [0, 0, 0]];
  const directional = light.getTypeID() === DIRECTIONAL, place = placeOf(light);
  return [[...place.asArray(), directional ? 0 : 1], light.diffuse.scale(light.getScaledIntensity() / Math.PI).asArray()];
}

/** Those of a mesh's scene that shine on it, of some types. */
export const lightsOn = (mesh, types) => (
  mesh.getScene().lights.filter((light) => types.includes(light.getTypeID()) && light.isEnabled() && light.canAffectMesh(mesh))
);
