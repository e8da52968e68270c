// What a material asks the program to draw for each frame: the distance to back faces, and depth maps of a light.

import * as THREE from 'three';
import { NodeMaterial } from 'three/webgpu';
import * as TSL from 'three/tsl';
import { ballOf } from './coarse_body.js';
import { deviceOf } from './renderer.js';

/** @typedef {import('./coarse_body.js').Body} Body */

const FAR = 60000;
const SIDE = 512;

/** A material that writes the distance from the eye (or from the light's plane) of one side of the faces.
 * @param {string} kind  of `rendererOf` @param {THREE.Side} side @param {boolean} fromPlane */
function distanceMaterial(kind, side, fromPlane) {
  if (kind === 'webgl') {
    return new THREE.ShaderMaterial({
      side,
      vertexShader: 'varying vec3 at; void main() { vec4 p = modelViewMatrix * vec4(position, 1.0); at = p.xyz; gl_Position = projectionMatrix * p; }',
      fragmentShader: `varying vec3 at; void main() { gl_FragColor = vec4(${fromPlane ? '-at.z' : 'length(at)'}, 0.0, 0.0, 1.0); }`,
    });
  }
  const material = new NodeMaterial();
  const distance = fromPlane ? TSL.positionView.z.negate() : TSL.positionView.length();
  return Object.assign(material, { side, fragmentNode: TSL.vec4(distance, 0, 0, 1) });
}

/** The views of one material on one renderer. */
export class DrawnViews {
  /** @param {string} kind  of `rendererOf` @param {import('../page_messages.js').Slot[]} textures
   * @param {import('../page_messages.js').Control[]} controls */
  constructor(kind, textures, controls) {
    this.kind = kind;
    this.rows = textures.filter((texture) => texture.drawn && !texture.texels).map((texture) => ({
      ...texture,
      matrix: controls.find((control) => control.drawn === texture.drawn && control.type === 'mat4')?.property,
      size: controls.find((control) => control.drawn === texture.drawn && control.type === 'float')?.property,
      target: this.target(),
      material: distanceMaterial(kind, texture.drawn === 'back_faces' ? THREE.BackSide : THREE.FrontSide, texture.drawn !== 'back_faces'),
    }));
    this.lamp = new THREE.OrthographicCamera();
  }

  target() {
    const filters = { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter };
    const options = { type: THREE.FloatType, format: THREE.RGBAFormat, ...filters };
    return this.kind === 'webgl' ? new THREE.WebGLRenderTarget(SIDE, SIDE, options) : new THREE.RenderTarget(SIDE, SIDE, options);
  }

  /** Draws all views, and gives the material its textures and matrices.
   * @param {import('./renderer.js').Renderer} renderer @param {THREE.Mesh<Body>} mesh
   * @param {import('./material.js').EmittedMaterial} material @param {THREE.Camera} camera @param {THREE.Light} light
   * @param {THREE.Vector2} size  of the picture, in pixels */
  draw(renderer, mesh, material, camera, light, size) {
    for (const row of this.rows) {
      const back = row.drawn === 'back_faces';
      if (back && (row.target.width !== size.x || row.target.height !== size.y)) row.target.setSize(size.x, size.y);
      const eye = back ? camera : this.lampFor(mesh, light);
      this.render(renderer, mesh, row, eye, back ? 0 : FAR);
      material[row.property] = row.target.texture;
      if (row.matrix) material[row.matrix] = this.lampMatrix(renderer);
      if (row.size) material[row.size] = SIDE;
    }
  }

  /** @param {import('./renderer.js').Renderer} renderer @param {THREE.Mesh} mesh @param {DrawnViews['rows'][0]} row
   * @param {THREE.Camera} eye @param {number} empty  what is written where nothing is */
  render(renderer, mesh, row, eye, empty) {
    const scene = new THREE.Scene();
    const own = mesh.material;
    const parent = mesh.parent;
    const before = { color: renderer.getClearColor(new THREE.Color()), alpha: renderer.getClearAlpha(), toneMapping: renderer.toneMapping };
    mesh.material = row.material;
    scene.add(mesh);
    renderer.toneMapping = THREE.NoToneMapping;
    renderer.setClearColor(new THREE.Color(empty, empty, empty), 1);
    renderer.setRenderTarget(/** @type {THREE.WebGLRenderTarget} */ (row.target));
    renderer.clear();
    renderer.render(scene, eye);
    renderer.setRenderTarget(null);
    renderer.setClearColor(before.color, before.alpha);
    renderer.toneMapping = before.toneMapping;
    mesh.material = own;
    parent?.add(mesh);
  }

  /** The camera of a light from afar, around the body.
   * @param {THREE.Mesh<Body>} mesh @param {THREE.Light} light */
  lampFor(mesh, light) {
    const ball = ballOf(mesh);
    const towards = light.position.clone().normalize();
    const radius = ball.radius * 1.02;
    Object.assign(this.lamp, { left: -radius, right: radius, top: radius, bottom: -radius, near: 0.5 * radius, far: 4 * radius });
    this.lamp.position.copy(ball.center).addScaledVector(towards, 2 * radius);
    this.lamp.up.set(0, Math.abs(towards.y) > 0.99 ? 0 : 1, Math.abs(towards.y) > 0.99 ? 1 : 0);
    this.lamp.lookAt(ball.center);
    this.lamp.coordinateSystem = this.kind === 'webgpu' ? THREE.WebGPUCoordinateSystem : THREE.WebGLCoordinateSystem;
    this.lamp.updateProjectionMatrix();
    this.lamp.updateMatrixWorld();
    return this.lamp;
  }

  /** World space to (u, v, distance from the light's plane, 1). WebGPU's render targets begin at the top.
   * @param {import('./renderer.js').Renderer} renderer */
  lampMatrix(renderer) {
    const { left, right, top, bottom, matrixWorldInverse } = this.lamp;
    const up = deviceOf(renderer) ? -1 : 1;
    const place = new THREE.Matrix4().set(
      1 / (right - left), 0, 0, 0.5,
      0, up / (top - bottom), 0, 0.5,
      0, 0, -1, 0,
      0, 0, 0, 1,
    );
    return place.multiply(matrixWorldInverse);
  }

  dispose() {
    for (const { target, material } of this.rows) { target.dispose(); material.dispose(); }
  }
}
