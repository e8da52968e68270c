// Builds the functions of modules of TSL in node, without a GPU: three's own builders write their WGSL and their GLSL.
//
// The first argument is the folder of npm's packages. A question is the text of a module; the answer has the texts, and what
// three complains about. Functions without a layout, which take textures or arrays, are imported alone.

import { createInterface } from 'node:readline';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const require = createRequire(`${process.argv[2]}/`);
const source = (file) => String(pathToFileURL(require.resolve(`three/src/${file}`)));
// before three is imported, which writes its complaints there
const complaints = [];
for (const level of ['error', 'warn']) console[level] = (...parts) => complaints.push(parts.map(String).join(' '));

const THREE = await import(source('Three.WebGPU.js'));
const WGSL = (await import(source('renderers/webgpu/nodes/WGSLNodeBuilder.js'))).default;
const GLSL = (await import(source('renderers/webgl-fallback/nodes/GLSLNodeBuilder.js'))).default;

// What the builders read of a renderer.
const rendererOf = (coordinateSystem) => ({
  backend: {},
  coordinateSystem,
  debug: { diagnostics: { keywords: true } },
  contextNode: { value: {}, getFlowContextData: () => ({}) },
  getRenderTarget: () => null,
  getMRT: () => null,
  hasFeature: () => false,
  hasCompatibility: () => true,
});

function built(Builder, coordinateSystem, module) {
  const object = { isObject3D: true, geometry: new THREE.BufferGeometry(), material: new THREE.NodeMaterial() };
  const builder = new Builder(object, rendererOf(coordinateSystem));
  builder.setShaderStage('fragment');
  // a struct is known once a value of it is built; a parameter may be the first use here
  for (const one of Object.values(module)) if (one.isStructTypeNode) one().structTypeNode.getNodeType(builder);
  for (const { isFn, shaderNode } of Object.values(module)) {
    if (!isFn || !shaderNode.layout) continue;
    builder.setBuildStage('generate');
    const node = builder.buildFunctionNode(shaderNode);
    for (const stage of ['setup', 'analyze', 'generate']) {
      builder.setBuildStage(stage);
      node.build(builder, 'property');
    }
  }
  return `${builder.getStructs('fragment')}\n${builder.getCodes('fragment')}`;
}

async function answer(text) {
  complaints.length = 0;
  const own = text.replace("'three/tsl'", JSON.stringify(source('Three.TSL.js')));
  const module = await import(`data:text/javascript,${encodeURIComponent(own)}`);
  const wgsl = built(WGSL, THREE.WebGPUCoordinateSystem, module);
  const glsl = built(GLSL, THREE.WebGLCoordinateSystem, module);
  return { wgsl, glsl, complaints: [...complaints] };
}

const reply = (value) => process.stdout.write(`@@${JSON.stringify(value)}\n`);
reply('ready');
for await (const line of createInterface({ input: process.stdin })) {
  const text = JSON.parse(line);
  reply(await answer(text).catch((error) => ({ error: `${error.name}: ${error.message}`, complaints: [...complaints] })));
}
