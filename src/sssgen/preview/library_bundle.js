// What the page and emitted modules import, as one file: `make setup` bundles it, and the wheel has it.

export * from 'three';
export * from 'three/webgpu';
export * from 'three/tsl';
export { log } from 'three/tsl';  // three has a function of this name, too
export { OrbitControls } from 'three/addons/controls/OrbitControls.js';
