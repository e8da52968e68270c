// What the page and emitted modules import, as one file: `make setup` bundles it, and the wheel has it.

export * from 'three';
export * from 'three/webgpu';
export * from 'three/tsl';
// what two of them have under one name
export { PMREMGenerator } from 'three';
export { AtomicFunctionNode, WebGLCapabilities } from 'three/webgpu';
export { log } from 'three/tsl';
export { OrbitControls } from 'three/addons/controls/OrbitControls.js';
export { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
export { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
export { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
export { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
export { zipSync } from 'three/addons/libs/fflate.module.js';
