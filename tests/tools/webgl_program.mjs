// The loader of programs in Node.js, on Dawn's device that draws nothing but checks everything: prints what it makes.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const [modules, folder, name, commands] = process.argv.slice(2);
const { create, globals } = await import(pathToFileURL(createRequire(modules + '/').resolve('webgpu')));
Object.assign(globalThis, globals);
const gpu = create(['backend=null']);
const device = await (await gpu.requestAdapter()).requestDevice();
const { Program, lastVertexFirst, show, generateMipmaps } = await import(pathToFileURL(`${folder}/webgl_program.mjs`));

const read = (file) => readFileSync(`${folder}/${file}`, 'utf-8'), description = JSON.parse(read(`${name}.program.json`));
device.pushErrorScope('validation');
const program = new Program(device, description, { vertex: read(description.stages.vertex.file), fragment: read(description.stages.fragment.file) });
const values = program.values(), buffer = device.createBuffer({ size: 1024, usage: GPUBufferUsage.VERTEX });
const picture = device.createTexture({ size: [8, 8], format: 'rgba8unorm', mipLevelCount: 4, usage: 0x17 });
const made = { program, values, buffer, device, picture, lastVertexFirst, show, generateMipmaps, draw };

/** Validates a draw with these vertices and options. */
function draw(sources, options = {}) {
  const vertices = program.vertices(sources), pipeline = program.pipeline({ vertices, targets: ['rgba8unorm'], ...options });
  const view = picture.createView({ mipLevelCount: 1 }), encoder = device.createCommandEncoder();
  const pass = encoder.beginRenderPass({ colorAttachments: [{ view, loadOp: 'clear', storeOp: 'store' }] });
  pass.setPipeline(pipeline);
  vertices.bind(pass);
  values.bind(pass);
  pass.draw(3);
  pass.end();
  device.queue.submit([encoder.finish()]);
  return vertices;
}

let result;
try {
  result = await new Function(...Object.keys(made), commands)(...Object.values(made));
} catch (error) {
  result = { error: error.message };
}
const fault = await device.popErrorScope();
console.log(JSON.stringify({ result, fault: fault?.message ?? '' }));
process.exit(gpu ? 0 : 1);
