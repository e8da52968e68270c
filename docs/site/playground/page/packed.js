// Files that are kept as PATH.gz: small on every host, also on one that compresses nothing.

/** The bytes of a packed file, beside this module or at an address.
 * @param {string} path @returns {Promise<ArrayBuffer>} */
export async function unpacked(path) {
  const response = await fetch(new URL(`${path}.gz`, import.meta.url));
  if (!response.ok) throw new Error(`${path}.gz: ${response.status}`);
  const bytes = new Uint8Array(await response.arrayBuffer());
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return bytes.buffer;  // the host has declared the compression, and the browser undone it
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

/** The JSON of a packed file.
 * @param {string} path @returns {Promise<any>} */
export async function unpackedJson(path) {
  return JSON.parse(new TextDecoder().decode(await unpacked(path)));
}
