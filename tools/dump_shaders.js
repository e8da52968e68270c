// Collects the shaders of a running WebGL page, as the driver receives them, and downloads them.
//
// Paste this text into the console of the browser while the page draws, or load it before all other scripts of the page
// (`<script src="dump_shaders.js"></script>`): then programs are found that the page uses only once, too. Then type
//
//     dumpedShaders.download()    // shaders.zip: NAME.vert and NAME.frag of each program, and programs.json
//     dumpedShaders.programs()    // the same as an array
//
// A program is collected when the page links it or uses it. Programs with equal texts are one. NAME is the name that the
// engine writes into the text (`#define SHADER_NAME` or `SHADER_TYPE`), or `program`; a number makes it unique. Not collected are
// programs of a worker (OffscreenCanvas), and programs of WebGPU, which has WGSL.

(() => {
  if (globalThis.dumpedShaders) return;
  const programs = new Map(); // both texts → record
  const seen = new WeakSet(); // WebGLProgram

  const list = (count, item) => Array.from({ length: count }, (_, index) => item(index)).filter(Boolean);

  // What the driver keeps of a variable: its GL type is written in hexadecimal, as in WebGL's specification.
  const variable = ({ name, type, size }, location) => ({ name, type: `0x${type.toString(16)}`, size, ...location });

  function collect(gl, program) {
    if (!program || seen.has(program) || !gl.getProgramParameter(program, gl.LINK_STATUS)) return;
    seen.add(program);
    const texts = {};
    for (const shader of gl.getAttachedShaders(program) ?? []) {
      const kind = gl.getShaderParameter(shader, gl.SHADER_TYPE) === gl.VERTEX_SHADER ? 'vertex' : 'fragment';
      texts[kind] = gl.getShaderSource(shader);
    }
    if (!texts.vertex || !texts.fragment) return; // detached before the script was there
    const key = `${texts.vertex}\u0000${texts.fragment}`;
    if (programs.has(key)) return;
    const count = (name) => gl.getProgramParameter(program, gl[name]) ?? 0;
    const isTwo = typeof WebGL2RenderingContext !== 'undefined' && gl instanceof WebGL2RenderingContext;
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
    const described = records.map(({ vertex, fragment, ...rest }) => rest);
    return {
      ...Object.fromEntries(records.flatMap(({ name, vertex, fragment }) => [[`${name}.vert`, vertex], [`${name}.frag`, fragment]])),
      'programs.json': `${JSON.stringify({ page: location.href, programs: described }, null, 1)}\n`,
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
