// Collects the shaders of a running WebGL page, as the driver receives them, and downloads them.
//
// Paste this text into the console of the browser while the page draws, or load it before all other scripts of the page
// (`<script src="dump_shaders.js"></script>`): then programs are found that the page uses only once, too. Then type
//
//     dumpedShaders.download()    // shaders.zip: NAME.vert and NAME.frag of each program, and programs.json
//     dumpedShaders.programs()    // the same as an array
//
// A program is collected when the page links it or uses it. Its first draw is described in programs.json, in the words of
// webgl_program.js: the values of uniforms, the attributes, how textures are read, and the state of the pipeline; draws by
// extensions (instances in WebGL 1, WEBGL_multi_draw) are not. Programs with equal texts are one. NAME is the name that
// the engine writes into the text (`#define SHADER_NAME` or `SHADER_TYPE`), or `program`; a number makes it unique. Not
// collected are programs of a worker (OffscreenCanvas), and programs of WebGPU, which has WGSL.

(() => {
  if (globalThis.dumpedShaders) return;
  const programs = new Map(); // both texts → record
  const seen = new WeakMap(); // WebGLProgram → record

  const list = (count, item) => Array.from({ length: count }, (_, index) => item(index)).filter(Boolean);

  // What the driver keeps of a variable: its GL type is written in hexadecimal, as in WebGL's specification.
  const variable = ({ name, type, size }, location) => ({ name, type: `0x${type.toString(16)}`, size, ...location });

  function collect(gl, program) {
    if (!program || seen.has(program) || !gl.getProgramParameter(program, gl.LINK_STATUS)) return;
    seen.set(program, null);
    const texts = {};
    for (const shader of gl.getAttachedShaders(program) ?? []) {
      const kind = gl.getShaderParameter(shader, gl.SHADER_TYPE) === gl.VERTEX_SHADER ? 'vertex' : 'fragment';
      texts[kind] = gl.getShaderSource(shader);
    }
    if (!texts.vertex || !texts.fragment) return; // detached before the script was there
    const key = `${texts.vertex}\u0000${texts.fragment}`;
    if (programs.has(key)) return seen.set(program, programs.get(key));
    const count = (name) => gl.getProgramParameter(program, gl[name]) ?? 0;
    const isTwo = isWebGL2(gl);
    programs.set(key, {
      name: unique(`${texts.fragment}\n${texts.vertex}`.match(/^[ \t]*#[ \t]*define[ \t]+SHADER_(?:NAME|TYPE)[ \t]+(\S+)/m)?.[1] ?? 'program'),
      webgl: isTwo ? 2 : 1,
      vertex: texts.vertex,
      fragment: texts.fragment,
      attributes: list(count('ACTIVE_ATTRIBUTES'), (index) => {
        const found = gl.getActiveAttrib(program, index);
        return found && variable(found, { location: gl.getAttribLocation(program, found.name) });
      }),
      uniforms: list(count('ACTIVE_UNIFORMS'), (index) => {
        const found = gl.getActiveUniform(program, index);
        return found && variable(found);
      }),
      feedback: isTwo ? list(count('TRANSFORM_FEEDBACK_VARYINGS'), (index) => gl.getTransformFeedbackVarying(program, index)?.name) : [],
    });
    seen.set(program, programs.get(key));
  }

  const isWebGL2 = (gl) => typeof WebGL2RenderingContext !== 'undefined' && gl instanceof WebGL2RenderingContext;
  const numbers = (value) => (typeof value === 'object' && value ? Array.from(value) : value);
  const TOPOLOGIES = ['point-list', 'line-list', 'line loop', 'line-strip', 'triangle-list', 'triangle-strip', 'triangle fan'];
  const COMPARES = ['never', 'less', 'equal', 'less-equal', 'greater', 'not-equal', 'greater-equal', 'always']; // from 0x200
  const FACTORS = {
    0: 'zero', 1: 'one', 0x300: 'src', 0x301: 'one-minus-src', 0x302: 'src-alpha', 0x303: 'one-minus-src-alpha', 0x304: 'dst-alpha', 0x305: 'one-minus-dst-alpha',
    0x306: 'dst', 0x307: 'one-minus-dst', 0x308: 'src-alpha-saturated', 0x8001: 'constant', 0x8002: 'one-minus-constant', 0x8003: 'constant', 0x8004: 'one-minus-constant',
  };
  const OPERATIONS = { 0x8006: 'add', 0x800a: 'subtract', 0x800b: 'reverse-subtract', 0x8007: 'min', 0x8008: 'max' };
  const WRAPS = { 0x2901: 'repeat', 0x812f: 'clamp-to-edge', 0x8370: 'mirror-repeat' };
  const FORMATS = { 0x1400: ['s', 8], 0x1401: ['u', 8], 0x1402: ['s', 16], 0x1403: ['u', 16], 0x1404: ['s', 32], 0x1405: ['u', 32], 0x1406: ['float', 32], 0x140b: ['float', 16] };
  const SAMPLERS = { // type of a uniform → target, and the parameter that is bound there
    0x8b5e: [0x0de1, 0x8069], 0x8b62: [0x0de1, 0x8069], 0x8dca: [0x0de1, 0x8069], 0x8dd2: [0x0de1, 0x8069], 0x8b60: [0x8513, 0x8514], 0x8dc5: [0x8513, 0x8514],
    0x8dcc: [0x8513, 0x8514], 0x8dd4: [0x8513, 0x8514], 0x8b5f: [0x806f, 0x806a], 0x8dcb: [0x806f, 0x806a], 0x8dd3: [0x806f, 0x806a],
    0x8dc1: [0x8c1a, 0x8c1d], 0x8dc4: [0x8c1a, 0x8c1d], 0x8dcf: [0x8c1a, 0x8c1d], 0x8dd7: [0x8c1a, 0x8c1d],
  };

  /** What the current draw gives to the program, as webgl_program.js takes it. */
  function described(gl, program, call, [mode, ...rest]) {
    const get = (parameter) => gl.getParameter(parameter), has = (parameter) => gl.isEnabled(parameter), isTwo = isWebGL2(gl);
    const uniforms = {}, textures = {}, attributes = {}, active = get(gl.ACTIVE_TEXTURE);
    for (let index = 0; index < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); index++) {
      const { name, type, size } = gl.getActiveUniform(program, index), base = name.replace(/\[0\]$/, '');
      for (let element = 0; element < size; element++) {
        const each = size > 1 ? `${base}[${element}]` : base, location = gl.getUniformLocation(program, each);
        if (!location) continue; // it is in a block
        const value = gl.getUniform(program, location);
        if (SAMPLERS[type]) textures[each] = sampler(gl, value, SAMPLERS[type], isTwo);
        else uniforms[base] = size > 1 ? [...(uniforms[base] ?? []), ...[numbers(value)].flat()] : numbers(value);
      }
    }
    gl.activeTexture(active);
    for (let index = 0; index < gl.getProgramParameter(program, gl.ACTIVE_ATTRIBUTES); index++) {
      const { name } = gl.getActiveAttrib(program, index), location = gl.getAttribLocation(program, name);
      if (location >= 0) attributes[name] = source(gl, location, isTwo);
    }
    const blend = (part) => ({ srcFactor: FACTORS[get(gl[`BLEND_SRC_${part}`])], dstFactor: FACTORS[get(gl[`BLEND_DST_${part}`])], operation: OPERATIONS[get(gl[`BLEND_EQUATION_${part}`])] });
    const bias = has(gl.POLYGON_OFFSET_FILL) ? { bias: get(gl.POLYGON_OFFSET_UNITS), slopeBias: get(gl.POLYGON_OFFSET_FACTOR) } : {};
    const pipeline = {
      topology: TOPOLOGIES[mode], cull: has(gl.CULL_FACE) ? { 0x404: 'front', 0x405: 'back' }[get(gl.CULL_FACE_MODE)] ?? 'all' : 'none', frontFace: get(gl.FRONT_FACE) === gl.CCW ? 'ccw' : 'cw',
      depth: { test: has(gl.DEPTH_TEST), write: get(gl.DEPTH_WRITEMASK), compare: COMPARES[get(gl.DEPTH_FUNC) - 0x200], ...bias },
      ...(has(gl.BLEND) ? { blend: { color: blend('RGB'), alpha: blend('ALPHA') } } : {}),
    };
    return { call: `${call}(${[TOPOLOGIES[mode], ...rest.map(String)].join(', ')})`, pipeline, uniforms, blocks: isTwo ? blocks(gl, program) : {}, textures, attributes };
  }

  function sampler(gl, unit, [target, binding], isTwo) {
    gl.activeTexture(gl.TEXTURE0 + unit);
    if (!gl.getParameter(binding)) return null; // black
    const own = isTwo && gl.getParameter(gl.SAMPLER_BINDING), get = (name) => (own ? gl.getSamplerParameter(own, name) : gl.getTexParameter(target, name));
    const min = get(gl.TEXTURE_MIN_FILTER), linear = (is) => (is ? 'linear' : 'nearest');
    return {
      minFilter: linear(min === 0x2601 || min === 0x2701 || min === 0x2703), magFilter: linear(get(gl.TEXTURE_MAG_FILTER) === gl.LINEAR),
      ...(min < 0x2700 ? { lodMaxClamp: 0 } : { mipmapFilter: linear(min > 0x2701) }), addressModeU: WRAPS[get(gl.TEXTURE_WRAP_S)], addressModeV: WRAPS[get(gl.TEXTURE_WRAP_T)],
      ...(isTwo && get(gl.TEXTURE_COMPARE_MODE) ? { compare: COMPARES[get(gl.TEXTURE_COMPARE_FUNC) - 0x200] } : {}),
    };
  }

  function source(gl, location, isTwo) {
    const get = (name) => gl.getVertexAttrib(location, name);
    if (!get(gl.VERTEX_ATTRIB_ARRAY_ENABLED)) return { constant: numbers(get(gl.CURRENT_VERTEX_ATTRIB)) };
    const size = get(gl.VERTEX_ATTRIB_ARRAY_SIZE), type = get(gl.VERTEX_ATTRIB_ARRAY_TYPE), [kind, bits] = FORMATS[type] ?? ['other', 32];
    const suffix = kind === 'float' ? '' : get(gl.VERTEX_ATTRIB_ARRAY_NORMALIZED) ? 'norm' : isTwo && get(gl.VERTEX_ATTRIB_ARRAY_INTEGER) ? 'int' : ' to float32: convert';
    return {
      format: `${kind}${suffix}${suffix.includes(' ') ? '' : bits}${size > 1 ? `x${size}` : ''}`, stride: get(gl.VERTEX_ATTRIB_ARRAY_STRIDE) || (size * bits) / 8,
      offset: gl.getVertexAttribOffset(location, gl.VERTEX_ATTRIB_ARRAY_POINTER), ...(isTwo && get(gl.VERTEX_ATTRIB_ARRAY_DIVISOR) ? { perInstance: true } : {}),
    };
  }

  /** The bytes of the uniform blocks, in std140. */
  function blocks(gl, program) {
    const result = {}, bound = gl.getParameter(gl.COPY_READ_BUFFER_BINDING);
    for (let index = 0; index < gl.getProgramParameter(program, gl.ACTIVE_UNIFORM_BLOCKS); index++) {
      const get = (name) => gl.getActiveUniformBlockParameter(program, index, name), slot = get(gl.UNIFORM_BLOCK_BINDING);
      const buffer = gl.getIndexedParameter(gl.UNIFORM_BUFFER_BINDING, slot), bytes = new Uint8Array(get(gl.UNIFORM_BLOCK_DATA_SIZE));
      if (!buffer) continue;
      gl.bindBuffer(gl.COPY_READ_BUFFER, buffer);
      gl.getBufferSubData(gl.COPY_READ_BUFFER, gl.getIndexedParameter(gl.UNIFORM_BUFFER_START, slot), bytes);
      result[gl.getActiveUniformBlockName(program, index)] = Array.from(bytes);
    }
    gl.bindBuffer(gl.COPY_READ_BUFFER, bound);
    return result;
  }

  const names = new Set();
  function unique(wanted) {
    const name = wanted.replace(/[^\w-]+/g, '_').slice(0, 60);
    let free = name;
    for (let number = 2; names.has(free.toLowerCase()); number++) free = `${name}_${number}`;
    names.add(free.toLowerCase()); // file systems may ignore the case of letters
    return free;
  }

  for (const Context of [globalThis.WebGLRenderingContext, globalThis.WebGL2RenderingContext]) {
    for (const name of Context ? ['drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced', 'drawRangeElements'] : []) {
      const own = Context.prototype[name];
      if (!own) continue; // WebGL 1
      Context.prototype[name] = function (/** @type {[number, ...number[]]} */ ...given) {
        try {
          const program = this.getParameter(this.CURRENT_PROGRAM), record = program && seen.get(program);
          if (record && !record.draw) record.draw = described(this, program, name, given);
        } catch (error) {
          console.warn('dump_shaders.js:', error); // the page goes on
        }
        return own.apply(this, given);
      };
    }
    for (const name of Context ? ['linkProgram', 'useProgram'] : []) {
      const own = Context.prototype[name];
      Context.prototype[name] = function (program) {
        const result = own.apply(this, arguments);
        try {
          if (!this.isContextLost()) collect(this, program);
        } catch (error) {
          console.warn('dump_shaders.js:', error); // the page goes on
        }
        return result;
      };
    }
  }

  // Files: every program's two stages, and their names, attributes and uniforms as JSON.
  function files() {
    const records = [...programs.values()];
    const listed = records.map(({ vertex, fragment, ...rest }) => rest);
    return {
      ...Object.fromEntries(records.flatMap(({ name, vertex, fragment }) => [[`${name}.vert`, vertex], [`${name}.frag`, fragment]])),
      'programs.json': `${JSON.stringify({ page: location.href, programs: listed }, null, 1)}\n`,
    };
  }

  function crc32(bytes) {
    let crc = ~0;
    for (const byte of bytes) {
      crc ^= byte;
      for (let bit = 0; bit < 8; bit++) crc = (crc >>> 1) ^ (crc & 1 && 0xedb88320);
    }
    return ~crc >>> 0;
  }

  // A ZIP file without compression (APPNOTE.TXT 4.3): browsers ask before they save many files.
  function zip(contents) {
    const parts = [];
    const directory = [];
    let end = 0;
    const add = (into, part) => {
      into.push(part);
      return part.length;
    };
    const numbers = (...pairs) => {
      const bytes = new Uint8Array(pairs.reduce((size, [width]) => size + width, 0));
      const view = new DataView(bytes.buffer);
      let at = 0;
      for (const [width, value] of pairs) {
        view[width === 2 ? 'setUint16' : 'setUint32'](at, value, true);
        at += width;
      }
      return bytes;
    };
    let listed = 0;
    for (const [name, text] of Object.entries(contents)) {
      const [path, data] = [name, text].map((part) => new TextEncoder().encode(part));
      const common = [[2, 20], [2, 0x800], [2, 0], [2, 0], [2, 0x21], [4, crc32(data)], [4, data.length], [4, data.length], [2, path.length], [2, 0]];
      const start = end;
      for (const part of [numbers([4, 0x04034b50], ...common), path, data]) end += add(parts, part);
      for (const part of [numbers([4, 0x02014b50], [2, 20], ...common, [2, 0], [2, 0], [2, 0], [4, 0], [4, start]), path]) listed += add(directory, part);
    }
    const count = Object.keys(contents).length;
    const tail = numbers([4, 0x06054b50], [2, 0], [2, 0], [2, count], [2, count], [4, listed], [4, end], [2, 0]);
    return new Blob([...parts, ...directory, tail], { type: 'application/zip' });
  }

  function download(name = 'shaders.zip') {
    if (!programs.size) return console.warn('No program yet: the page must draw once after this script was started.');
    const link = Object.assign(document.createElement('a'), { href: URL.createObjectURL(zip(files())), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
    return `${programs.size} programs`;
  }

  globalThis.dumpedShaders = { programs: () => [...programs.values()], files, zip: () => zip(files()), download };
})();
