// Records what a page draws with WebGL 2: for each draw its program, uniforms, attributes, indices, textures, state and
// target; and clears, copies between framebuffers, and mipmaps of textures that were drawn. Content of other textures is
// read back when a draw uses it. What this does not follow is an error, so that nothing is left out unseen.

const FORMATS = {
  RGBA8: ['rgba8unorm', 'UNSIGNED_BYTE', 4], SRGB8_ALPHA8: ['rgba8unorm-srgb', 'UNSIGNED_BYTE', 4], RGB8: ['rgba8unorm', 'UNSIGNED_BYTE', 4],
  R8: ['rgba8unorm', 'UNSIGNED_BYTE', 4], RG8: ['rgba8unorm', 'UNSIGNED_BYTE', 4], RGBA16F: ['rgba16float', 'FLOAT', 16],
  RGBA32F: ['rgba32float', 'FLOAT', 16], R32F: ['rgba32float', 'FLOAT', 16], RG16F: ['rgba16float', 'FLOAT', 16], R16F: ['rgba16float', 'FLOAT', 16], R32UI: ['rgba32uint', 'UNSIGNED_INT', 16],
  DEPTH_COMPONENT24: ['depth24plus'], DEPTH_COMPONENT16: ['depth16unorm'], DEPTH_COMPONENT32F: ['depth32float'], DEPTH24_STENCIL8: ['depth24plus-stencil8'],
  DEPTH32F_STENCIL8: ['depth32float-stencil8'],
};

/** Wraps a context, and returns what it draws from now on. */
export function record(gl) {
  const commands = [], programs = [], ids = new Map(), textures = new Map(), renderbuffers = new Map(), framebuffers = new Map();
  const name = (value) => Object.keys(FORMATS).find((key) => gl[key] === value) ?? fail(`internal format 0x${value.toString(16)}`);
  const fail = (text) => {
    throw new Error(`the recorder does not follow ${text}`);
  };
  const wrap = (method, after) => {
    const original = gl[method].bind(gl);
    gl[method] = (...parts) => {
      const result = original(...parts);
      after(parts, result);
      return result;
    };
    return original;
  };
  const before = (method, action) => {
    const original = gl[method].bind(gl);
    gl[method] = (...parts) => {
      action(parts);
      return original(...parts);
    };
  };
  const idOf = (object) => ids.get(object) ?? ids.set(object, ids.size).get(object);
  const BINDINGS = { [gl.TEXTURE_2D]: gl.TEXTURE_BINDING_2D, [gl.TEXTURE_3D]: gl.TEXTURE_BINDING_3D, [gl.TEXTURE_2D_ARRAY]: gl.TEXTURE_BINDING_2D_ARRAY, [gl.TEXTURE_CUBE_MAP]: gl.TEXTURE_BINDING_CUBE_MAP };
  const targetOf = (target) => (target >= gl.TEXTURE_CUBE_MAP_POSITIVE_X && target <= gl.TEXTURE_CUBE_MAP_NEGATIVE_Z ? gl.TEXTURE_CUBE_MAP : target);
  const bound = (target) => {
    const object = gl.getParameter(BINDINGS[targetOf(target)]);
    if (!textures.has(object)) textures.set(object, { id: idOf(object), object, target: targetOf(target), levels: 1, isDrawn: false, isChanged: false });
    return textures.get(object);
  };

  // Textures
  const placed = (target, levels, format, width, height, depth) => {
    const texture = bound(target);
    Object.assign(texture, { levels, format: name(format), size: [width, height, depth ?? (texture.target === gl.TEXTURE_CUBE_MAP ? 6 : 1)], isChanged: true });
  };
  wrap('texStorage2D', ([target, levels, format, width, height]) => placed(target, levels, format, width, height));
  wrap('texStorage3D', ([target, levels, format, width, height, depth]) => placed(target, levels, format, width, height, depth));
  const sized = (format, type) => ({ [gl.RGBA]: { [gl.UNSIGNED_BYTE]: gl.RGBA8 }, [gl.RGB]: { [gl.UNSIGNED_BYTE]: gl.RGB8 } })[format]?.[type] ?? format;
  wrap('texImage2D', ([target, level, format, ...rest]) => {
    const [width, height, type] = rest.length > 3 ? [rest[0], rest[1], rest[4]] : [rest[2].width, rest[2].height, rest[1]];
    if (level) bound(target).levels = Math.max(bound(target).levels, level + 1);
    else placed(target, 1, sized(format, type), width, height);
  });
  wrap('texImage3D', ([target, level, format, width, height, depth, , , type]) => (level ? fail('levels by texImage3D') : placed(target, 1, sized(format, type), width, height, depth)));
  for (const method of ['texSubImage2D', 'texSubImage3D']) wrap(method, ([target]) => (bound(target).isChanged = true));
  for (const method of ['compressedTexImage2D', 'compressedTexSubImage2D', 'copyTexImage2D', 'copyTexSubImage2D', 'copyTexSubImage3D', 'bindSampler', 'drawRangeElements', 'beginTransformFeedback', 'clearBufferfv', 'clearBufferfi', 'clearBufferiv'])
    before(method, () => fail(method));
  wrap('generateMipmap', ([target]) => {
    const texture = bound(target);
    texture.levels = Math.floor(Math.log2(Math.max(...texture.size.slice(0, texture.target === gl.TEXTURE_3D ? 3 : 2)))) + 1;
    if (texture.isDrawn) commands.push({ kind: 'mipmaps', texture: texture.id });
    else texture.isChanged = true;
  });

  // Framebuffers
  const current = (target) => gl.getParameter(target === gl.READ_FRAMEBUFFER ? gl.READ_FRAMEBUFFER_BINDING : gl.DRAW_FRAMEBUFFER_BINDING);
  const attach = (target, attachment, what) => {
    const framebuffer = current(target);
    if (!framebuffers.has(framebuffer)) framebuffers.set(framebuffer, {});
    framebuffers.get(framebuffer)[attachment] = what;
  };
  const ofTexture = (object, level, layer) => object && { texture: textures.get(object), level, layer };
  wrap('framebufferTexture2D', ([target, attachment, face, object, level]) => attach(target, attachment, ofTexture(object, level, targetOf(face) === face ? 0 : face - gl.TEXTURE_CUBE_MAP_POSITIVE_X)));
  wrap('framebufferTextureLayer', ([target, attachment, object, level, layer]) => attach(target, attachment, ofTexture(object, level, layer)));
  wrap('framebufferRenderbuffer', ([target, attachment, , object]) => attach(target, attachment, object && { renderbuffer: renderbuffers.get(object) }));
  const buffered = (format, width, height, samples) => {
    const object = gl.getParameter(gl.RENDERBUFFER_BINDING);
    renderbuffers.set(object, { id: idOf(object), format: name(format), size: [width, height, 1], samples });
  };
  wrap('renderbufferStorage', ([, format, width, height]) => buffered(format, width, height, 1));
  wrap('renderbufferStorageMultisample', ([, samples, format, width, height]) => buffered(format, width, height, Math.max(1, samples)));

  const described = (attachment) => {
    if (!attachment) return null;
    const { texture, renderbuffer, level = 0, layer = 0 } = attachment, it = texture ?? renderbuffer;
    if (texture) texture.isDrawn = true;
    return { id: it.id, format: FORMATS[it.format][0], size: it.size, levels: it.levels ?? 1, samples: it.samples ?? 1, level, layer, target: texture?.target === gl.TEXTURE_3D ? '3d' : '2d' };
  };
  const canvasSize = () => [gl.drawingBufferWidth, gl.drawingBufferHeight, 1];
  const targets = (target) => {
    const framebuffer = current(target);
    if (!framebuffer) {
      const common = { size: canvasSize(), levels: 1, samples: 1, level: 0, layer: 0, target: '2d' };
      return { colors: [{ id: 'canvas', format: 'rgba8unorm', ...common }], depth: { id: 'canvas depth', format: 'depth24plus', ...common } };
    }
    const parts = framebuffers.get(framebuffer) ?? {}, colors = [];
    for (let index = 0; index < 8; index++) {
      const part = parts[gl.COLOR_ATTACHMENT0 + index];
      if (target === gl.READ_FRAMEBUFFER ? index === 0 : gl.getParameter(gl.DRAW_BUFFER0 + index) !== gl.NONE) colors[index] = described(part);
    }
    return { colors, depth: described(parts[gl.DEPTH_ATTACHMENT] ?? parts[gl.DEPTH_STENCIL_ATTACHMENT]) };
  };

  // Draws. Those of an extension are not followed: three.js then makes single ones.
  const extension = gl.getExtension.bind(gl);
  gl.getExtension = (label) => (label === 'WEBGL_multi_draw' ? null : extension(label));
  const bytesOf = (buffer) => {
    const old = gl.getParameter(gl.COPY_READ_BUFFER_BINDING);
    gl.bindBuffer(gl.COPY_READ_BUFFER, buffer);
    const bytes = new Uint8Array(gl.getBufferParameter(gl.COPY_READ_BUFFER, gl.BUFFER_SIZE));
    gl.getBufferSubData(gl.COPY_READ_BUFFER, 0, bytes);
    gl.bindBuffer(gl.COPY_READ_BUFFER, old);
    return bytes;
  };
  const COMPONENTS = { [gl.FLOAT]: Float32Array, [gl.BYTE]: Int8Array, [gl.UNSIGNED_BYTE]: Uint8Array, [gl.SHORT]: Int16Array, [gl.UNSIGNED_SHORT]: Uint16Array, [gl.INT]: Int32Array, [gl.UNSIGNED_INT]: Uint32Array };
  const attribute = (location) => {
    const get = (parameter) => gl.getVertexAttrib(location, parameter);
    if (!get(gl.VERTEX_ATTRIB_ARRAY_ENABLED)) return { constant: Array.from(get(gl.CURRENT_VERTEX_ATTRIB)) };
    const size = get(gl.VERTEX_ATTRIB_ARRAY_SIZE), type = get(gl.VERTEX_ATTRIB_ARRAY_TYPE), Numbers = COMPONENTS[type] ?? fail(`attributes of type ${type}`);
    const width = Numbers.BYTES_PER_ELEMENT, stride = get(gl.VERTEX_ATTRIB_ARRAY_STRIDE) || size * width, first = gl.getVertexAttribOffset(location, gl.VERTEX_ATTRIB_ARRAY_POINTER);
    const bytes = bytesOf(get(gl.VERTEX_ATTRIB_ARRAY_BUFFER_BINDING)), isInteger = get(gl.VERTEX_ATTRIB_ARRAY_INTEGER);
    const count = Math.floor((bytes.byteLength - first - size * width) / stride) + 1, largest = get(gl.VERTEX_ATTRIB_ARRAY_NORMALIZED) ? 2 ** (8 * width - (type === gl.BYTE || type === gl.SHORT || type === gl.INT ? 1 : 0)) - 1 : 1;
    const data = new (isInteger ? (type === gl.UNSIGNED_INT ? Uint32Array : Int32Array) : Float32Array)(count * size);
    const aligned = first % width === 0 && stride % width === 0 ? new Numbers(bytes.buffer, 0, Math.floor(bytes.byteLength / width)) : fail('attributes that are not aligned');
    for (let vertex = 0; vertex < count; vertex++)
      for (let part = 0; part < size; part++) data[vertex * size + part] = Math.max(aligned[(first + vertex * stride) / width + part] / largest, largest === 1 ? -Infinity : -1);
    return { data, size, isInteger, divisor: get(gl.VERTEX_ATTRIB_ARRAY_DIVISOR) };
  };
  const SAMPLERS = {
    [gl.SAMPLER_2D]: gl.TEXTURE_2D, [gl.SAMPLER_3D]: gl.TEXTURE_3D, [gl.SAMPLER_CUBE]: gl.TEXTURE_CUBE_MAP, [gl.SAMPLER_2D_ARRAY]: gl.TEXTURE_2D_ARRAY, [gl.SAMPLER_2D_SHADOW]: gl.TEXTURE_2D,
    [gl.SAMPLER_CUBE_SHADOW]: gl.TEXTURE_CUBE_MAP, [gl.SAMPLER_2D_ARRAY_SHADOW]: gl.TEXTURE_2D_ARRAY, [gl.UNSIGNED_INT_SAMPLER_2D]: gl.TEXTURE_2D, [gl.INT_SAMPLER_2D]: gl.TEXTURE_2D,
  };
  const textureAt = (unit, target) => {
    const active = gl.getParameter(gl.ACTIVE_TEXTURE);
    gl.activeTexture(gl.TEXTURE0 + unit);
    const object = gl.getParameter(BINDINGS[target]);
    let found = null;
    if (object) {
      const get = (parameter) => gl.getTexParameter(target, parameter), texture = bound(target);
      if (texture.isChanged && !texture.isDrawn) snapshot(texture);
      found = {
        id: texture.id, min: get(gl.TEXTURE_MIN_FILTER), mag: get(gl.TEXTURE_MAG_FILTER), wrap: [get(gl.TEXTURE_WRAP_S), get(gl.TEXTURE_WRAP_T), get(gl.TEXTURE_WRAP_R)],
        compare: get(gl.TEXTURE_COMPARE_MODE) === gl.NONE ? 0 : get(gl.TEXTURE_COMPARE_FUNC),
        anisotropy: gl.getExtension('EXT_texture_filter_anisotropic') ? get(0x84fe) : 1,
        format: FORMATS[texture.format][0], size: texture.size, levels: texture.levels, target: target === gl.TEXTURE_3D ? '3d' : '2d',
      };
    }
    gl.activeTexture(active);
    return found;
  };
  const snapshot = (texture) => {
    const [format, type, bytes] = FORMATS[texture.format], [width, height, depth] = texture.size, levels = [];
    if (!type) fail('depth textures that are not drawn');
    const framebuffer = gl.createFramebuffer(), old = current(gl.READ_FRAMEBUFFER), pack = gl.getParameter(gl.PIXEL_PACK_BUFFER_BINDING);
    originalBind(gl.READ_FRAMEBUFFER, framebuffer);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    for (let level = 0; level < texture.levels; level++)
      for (let layer = 0; layer < depth; layer++) {
        const size = [Math.max(1, width >> level), Math.max(1, height >> level)];
        if (texture.target === gl.TEXTURE_2D_ARRAY || texture.target === gl.TEXTURE_3D) layerOf(gl.READ_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, texture.object, level, layer);
        else faceOf(gl.READ_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, texture.target === gl.TEXTURE_CUBE_MAP ? gl.TEXTURE_CUBE_MAP_POSITIVE_X + layer : gl.TEXTURE_2D, texture.object, level);
        if (gl.checkFramebufferStatus(gl.READ_FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE) fail(`the content of ${texture.format}`);
        const Numbers = { UNSIGNED_BYTE: Uint8Array, FLOAT: Float32Array, UNSIGNED_INT: Uint32Array }[type], data = new Numbers(size[0] * size[1] * 4);
        gl.readPixels(0, 0, ...size, type === 'UNSIGNED_INT' ? gl.RGBA_INTEGER : gl.RGBA, gl[type], data);
        if (gl.getError()) fail(`reading ${texture.format}`);
        levels.push({ level, layer, size, data: new Uint8Array(data.buffer) });
      }
    originalBind(gl.READ_FRAMEBUFFER, old);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, pack);
    gl.deleteFramebuffer(framebuffer);
    texture.isChanged = false;
    commands.push({ kind: 'texels', texture: texture.id, format: type === 'FLOAT' ? 'rgba32float' : format, size: texture.size, levels: texture.levels, target: texture.target === gl.TEXTURE_3D ? '3d' : '2d', bytes, texels: levels });
  };
  const originalBind = gl.bindFramebuffer.bind(gl);
  const faceOf = WebGL2RenderingContext.prototype.framebufferTexture2D.bind(gl), layerOf = WebGL2RenderingContext.prototype.framebufferTextureLayer.bind(gl);

  const draw = (topology, count, first, instances, index) => {
    const program = gl.getParameter(gl.CURRENT_PROGRAM), uniforms = {}, used = {}, attributes = {};
    const blocks = {}, inBlocks = new Set();
    for (let number = 0; number < gl.getProgramParameter(program, gl.ACTIVE_UNIFORM_BLOCKS); number++) {
      const parameter = (which) => gl.getActiveUniformBlockParameter(program, number, which), slot = parameter(gl.UNIFORM_BLOCK_BINDING);
      const part = (which) => gl.getIndexedParameter(which, slot), bytes = bytesOf(part(gl.UNIFORM_BUFFER_BINDING)), start = part(gl.UNIFORM_BUFFER_START);
      blocks[gl.getActiveUniformBlockName(program, number)] = bytes.slice(start, start + (part(gl.UNIFORM_BUFFER_SIZE) || bytes.length));
      for (const member of parameter(gl.UNIFORM_BLOCK_ACTIVE_UNIFORM_INDICES)) inBlocks.add(member);
    }
    for (let number = 0; number < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); number++) {
      if (inBlocks.has(number)) continue;
      const { name: label, size, type } = gl.getActiveUniform(program, number), base = label.replace(/\[0\]$/, ''), values = [];
      for (let element = 0; element < size; element++) {
        const each = size > 1 || base !== label ? `${base}[${element}]` : label, value = gl.getUniform(program, gl.getUniformLocation(program, each));
        if (SAMPLERS[type]) used[each] = textureAt(value, SAMPLERS[type]);
        else values.push(...(typeof value === 'object' ? value : [value]));
      }
      if (!SAMPLERS[type]) uniforms[base] = values;
    }
    const ELEMENTS = { [gl.FLOAT_MAT2]: 2, [gl.FLOAT_MAT3]: 3, [gl.FLOAT_MAT4]: 4 };
    for (let number = 0; number < gl.getProgramParameter(program, gl.ACTIVE_ATTRIBUTES); number++) {
      const { name: label, type } = gl.getActiveAttrib(program, number);
      if (label.startsWith('gl_')) continue;
      const location = gl.getAttribLocation(program, label), columns = ELEMENTS[type] ?? 1;
      attributes[label] = Array.from({ length: columns }, (_, column) => attribute(location + column));
    }
    let id = programs.findIndex((each) => each.program === program);
    if (id < 0) {
      const shaders = gl.getAttachedShaders(program).map((shader) => [gl.getShaderParameter(shader, gl.SHADER_TYPE), gl.getShaderSource(shader)]);
      id = programs.push({ program, vertex: shaders.find(([type]) => type === gl.VERTEX_SHADER)[1], fragment: shaders.find(([type]) => type === gl.FRAGMENT_SHADER)[1] }) - 1;
    }
    const get = (parameter) => gl.getParameter(parameter), has = (parameter) => gl.isEnabled(parameter);
    if (has(gl.STENCIL_TEST) && get(gl.STENCIL_BITS)) fail('the stencil test');
    commands.push({
      kind: 'draw', program: id, uniforms, blocks, textures: used, attributes, topology, count, first, instances, index, into: targets(gl.DRAW_FRAMEBUFFER),
      viewport: Array.from(get(gl.VIEWPORT)), depthRange: Array.from(get(gl.DEPTH_RANGE)), scissor: has(gl.SCISSOR_TEST) ? Array.from(get(gl.SCISSOR_BOX)) : null,
      cull: has(gl.CULL_FACE) ? get(gl.CULL_FACE_MODE) : 0, front: get(gl.FRONT_FACE), mask: get(gl.COLOR_WRITEMASK), color: Array.from(get(gl.BLEND_COLOR)),
      depth: { test: has(gl.DEPTH_TEST), write: get(gl.DEPTH_WRITEMASK), compare: get(gl.DEPTH_FUNC), bias: has(gl.POLYGON_OFFSET_FILL) ? [get(gl.POLYGON_OFFSET_UNITS), get(gl.POLYGON_OFFSET_FACTOR)] : [0, 0] },
      blend: has(gl.BLEND) ? { color: [get(gl.BLEND_SRC_RGB), get(gl.BLEND_DST_RGB), get(gl.BLEND_EQUATION_RGB)], alpha: [get(gl.BLEND_SRC_ALPHA), get(gl.BLEND_DST_ALPHA), get(gl.BLEND_EQUATION_ALPHA)] } : null,
    });
  };
  const indices = (count, type, offset) => {
    const bytes = bytesOf(gl.getParameter(gl.ELEMENT_ARRAY_BUFFER_BINDING)), Numbers = COMPONENTS[type];
    return Array.from(new Numbers(bytes.buffer, offset, count));
  };
  before('drawArrays', ([mode, first, count]) => draw(mode, count, first, 1, null));
  before('drawArraysInstanced', ([mode, first, count, instances]) => draw(mode, count, first, instances, null));
  before('drawElements', ([mode, count, type, offset]) => draw(mode, count, 0, 1, indices(count, type, offset)));
  before('drawElementsInstanced', ([mode, count, type, offset, instances]) => draw(mode, count, 0, instances, indices(count, type, offset)));
  before('clear', ([mask]) => {
    commands.push({
      kind: 'clear', into: targets(gl.DRAW_FRAMEBUFFER), color: mask & gl.COLOR_BUFFER_BIT ? Array.from(gl.getParameter(gl.COLOR_CLEAR_VALUE)) : null,
      depth: mask & gl.DEPTH_BUFFER_BIT ? gl.getParameter(gl.DEPTH_CLEAR_VALUE) : null, scissor: gl.isEnabled(gl.SCISSOR_TEST) ? Array.from(gl.getParameter(gl.SCISSOR_BOX)) : null,
    });
  });
  before('blitFramebuffer', ([x0, y0, x1, y1, a0, b0, a1, b1, mask]) => {
    if ([x0, y0, x1, y1].join() !== [a0, b0, a1, b1].join() || x0 || y0) fail('blitFramebuffer with a change of size');
    commands.push({ kind: 'resolve', from: targets(gl.READ_FRAMEBUFFER), into: targets(gl.DRAW_FRAMEBUFFER), color: !!(mask & gl.COLOR_BUFFER_BIT), depth: !!(mask & gl.DEPTH_BUFFER_BIT) });
  });
  return { commands, programs };
}
