// Volumes in PlayCanvas, whose texels reach WebGPU, too.

import * as pc from 'playcanvas';

const filled = new WeakSet();

/** PlayCanvas 2.23 leaves the texels of volumes out in WebGPU: here they follow, once and whenever they are `new`. */
export function withTexels(texture, isNew = false) {
  const { impl, device } = texture;
  if (!texture.volume || impl.desc?.dimension !== '3d' || (filled.has(texture) && !isNew)) return texture;
  const size = { width: texture.width, height: texture.height, depthOrArrayLayers: texture.depth };
  if (!filled.has(texture)) {
    filled.add(texture);
    Object.assign(impl.desc, { size, mipLevelCount: 1 });
    impl.gpuTexture = device.wgpu.createTexture(impl.desc);
    impl.view = impl.gpuTexture.createView({ dimension: '3d' });
  }
  const data = texture.getSource();
  const layout = { bytesPerRow: data.byteLength / (size.height * size.depthOrArrayLayers), rowsPerImage: size.height };
  device.wgpu.queue.writeTexture({ texture: impl.gpuTexture }, data, layout, size);
  return texture;
}

/** A volume of half floats that filters blend; `data` stays its texels. */
export function volumeOf(device, name, data, { width, height, depth }) {
  return new pc.Texture(device, {
    name, width, height, depth, volume: true, format: pc.PIXELFORMAT_RGBA16F, mipmaps: false, minFilter: pc.FILTER_LINEAR, magFilter: pc.FILTER_LINEAR,
    addressU: pc.ADDRESS_CLAMP_TO_EDGE, addressV: pc.ADDRESS_CLAMP_TO_EDGE, addressW: pc.ADDRESS_CLAMP_TO_EDGE, levels: /** @type {any} */ ([data]),
  });
}

/** Takes texels that have changed. @param {any} texture */
export function refill(texture) {
  if (texture.device.isWebGPU) withTexels(texture, true);
  else texture.upload();
}
