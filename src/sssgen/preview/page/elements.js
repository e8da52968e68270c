// Elements of the page: those of its HTML by their id, and new ones.

/** The element with an id. Throws where the page has none of that kind.
 * @template {HTMLElement} T @param {string} id @param {new () => T} Kind @returns {T} */
export function element(id, Kind) {
  const result = document.getElementById(id);
  if (result instanceof Kind) return result;
  throw new Error(`the page has no ${Kind.name} #${id}`);
}

export const box = (/** @type {string} */ id) => element(id, HTMLElement);
export const button = (/** @type {string} */ id) => element(id, HTMLButtonElement);
export const checkbox = (/** @type {string} */ id) => element(id, HTMLInputElement);
export const list = (/** @type {string} */ id) => element(id, HTMLSelectElement);

/** A new element with properties and children.
 * @template {keyof HTMLElementTagNameMap} T @param {T} tag @param {object} [properties] @param {(Node | string)[]} children
 * @returns {HTMLElementTagNameMap[T]} */
export function make(tag, properties = {}, ...children) {
  const result = Object.assign(document.createElement(tag), properties);
  result.append(...children);
  return result;
}
