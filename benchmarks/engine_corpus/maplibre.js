// MapLibre GL: one map for each kind of layer, on the plane, on the globe and on terrain; sources are in the style.

import * as maplibre from 'maplibre-gl';
import { picture, run, wait } from './pages_common.js';

maplibre.setWorkerUrl('/packages/node_modules/maplibre-gl/dist/maplibre-gl-worker.mjs');
const feature = (geometry, properties = {}) => ({ type: 'Feature', properties: { value: 3, color: '#ff0000', ...properties }, geometry });
const DATA = { type: 'FeatureCollection', features: [
  feature({ type: 'Polygon', coordinates: [[[-10, -10], [10, -10], [10, 10], [-10, 10], [-10, -10]]] }),
  feature({ type: 'LineString', coordinates: [[-20, 0], [0, 5], [20, 0]] }), feature({ type: 'Point', coordinates: [3, 3] }), feature({ type: 'Point', coordinates: [-3, 4] }, { value: 9 }),
] };
const SOURCES = {
  shapes: { type: 'geojson', data: DATA, lineMetrics: true }, clusters: { type: 'geojson', data: DATA, cluster: true },
  picture: { type: 'image', url: picture, coordinates: [[-10, 10], [10, 10], [10, -10], [-10, -10]] }, tiles: { type: 'raster', tiles: [picture], tileSize: 256 }, heights: { type: 'raster-dem', tiles: [picture], tileSize: 256 },
};
const byValue = (low, high) => ['interpolate', ['linear'], ['get', 'value'], 0, low, 10, high];
const byZoom = (low, high) => ['interpolate', ['linear'], ['zoom'], 0, low, 10, high];
const LAYERS = {
  background: { type: 'background', paint: { 'background-color': '#abc' } }, 'background pattern': { type: 'background', paint: { 'background-pattern': 'icon' } },
  fill: { type: 'fill', source: 'shapes', paint: { 'fill-color': '#f00', 'fill-outline-color': '#0f0', 'fill-antialias': true } }, 'fill by data': { type: 'fill', source: 'shapes', paint: { 'fill-color': ['get', 'color'], 'fill-opacity': byValue(0, 1) } }, 'fill pattern': { type: 'fill', source: 'shapes', paint: { 'fill-pattern': 'icon', 'fill-opacity': byZoom(0.3, 1) } },
  'fill pattern by data': { type: 'fill', source: 'shapes', paint: { 'fill-pattern': ['case', ['>', ['get', 'value'], 5], 'icon', 'sdf'] } },
  extrusion: { type: 'fill-extrusion', source: 'shapes', paint: { 'fill-extrusion-height': 9e5, 'fill-extrusion-color': '#f00' } }, 'extrusion by data': { type: 'fill-extrusion', source: 'shapes', paint: { 'fill-extrusion-height': byValue(0, 9e5), 'fill-extrusion-base': byValue(0, 100), 'fill-extrusion-color': ['get', 'color'] } }, 'extrusion pattern': { type: 'fill-extrusion', source: 'shapes', paint: { 'fill-extrusion-height': 9e5, 'fill-extrusion-pattern': 'icon' } },
  line: { type: 'line', source: 'shapes', paint: { 'line-width': 3, 'line-color': '#00f' } }, 'line by data': { type: 'line', source: 'shapes', paint: { 'line-width': byValue(1, 8), 'line-color': ['get', 'color'], 'line-blur': byValue(0, 2), 'line-offset': byValue(0, 3), 'line-gap-width': byValue(0, 4), 'line-opacity': byValue(0.2, 1) } }, dashes: { type: 'line', source: 'shapes', paint: { 'line-width': byZoom(2, 8), 'line-dasharray': [2, 1] } }, gradient: { type: 'line', source: 'shapes', paint: { 'line-width': 4, 'line-gradient': ['interpolate', ['linear'], ['line-progress'], 0, 'red', 1, 'blue'] } }, 'line pattern': { type: 'line', source: 'shapes', paint: { 'line-width': 6, 'line-pattern': 'icon' } },
  'gradient with dashes': { type: 'line', source: 'shapes', paint: { 'line-width': 4, 'line-dasharray': [2, 1], 'line-gradient': ['interpolate', ['linear'], ['line-progress'], 0, 'red', 1, 'blue'] } },
  circle: { type: 'circle', source: 'shapes', paint: { 'circle-radius': 6 } }, 'circle by data': { type: 'circle', source: 'shapes', paint: { 'circle-radius': byValue(2, 9), 'circle-color': ['get', 'color'], 'circle-blur': byValue(0, 1), 'circle-opacity': byValue(0.2, 1), 'circle-stroke-width': byValue(0, 3), 'circle-stroke-color': ['get', 'color'], 'circle-pitch-alignment': 'map' } }, clusters: { type: 'circle', source: 'clusters', paint: { 'circle-radius': ['step', ['coalesce', ['get', 'point_count'], 0], 3, 1, 6] } },
  heatmap: { type: 'heatmap', source: 'shapes', paint: { 'heatmap-radius': byZoom(4, 30) } }, 'heatmap by data': { type: 'heatmap', source: 'shapes', paint: { 'heatmap-weight': byValue(0, 1), 'heatmap-radius': byValue(2, 20) } },
  symbol: { type: 'symbol', source: 'shapes', layout: { 'icon-image': 'icon', 'icon-allow-overlap': true } }, 'symbol of distances': { type: 'symbol', source: 'shapes', layout: { 'icon-image': 'sdf', 'icon-allow-overlap': true }, paint: { 'icon-color': ['get', 'color'], 'icon-halo-width': byValue(0, 2), 'icon-halo-color': '#fff' } }, text: { type: 'symbol', source: 'shapes', layout: { 'text-field': 'text', 'text-font': ['any'], 'text-allow-overlap': true }, paint: { 'text-halo-width': 1, 'text-halo-color': '#fff' } }, 'text and icon': { type: 'symbol', source: 'shapes', layout: { 'text-field': 'text', 'text-font': ['any'], 'icon-image': 'sdf', 'icon-text-fit': 'both', 'text-size': byValue(8, 20), 'text-allow-overlap': true } }, 'text along lines': { type: 'symbol', source: 'shapes', layout: { 'text-field': 'text', 'text-font': ['any'], 'symbol-placement': 'line', 'text-size': byZoom(8, 20) } }, 'formatted text': { type: 'symbol', source: 'shapes', layout: { 'text-field': ['format', 'a', { 'text-color': 'red' }, ['image', 'icon'], {}], 'text-font': ['any'], 'text-allow-overlap': true } },
  raster: { type: 'raster', source: 'picture', paint: { 'raster-saturation': 0.5, 'raster-hue-rotate': 20, 'raster-contrast': 0.2 } }, tiles: { type: 'raster', source: 'tiles' }, hillshade: { type: 'hillshade', source: 'heights' }, relief: { type: 'color-relief', source: 'heights', paint: { 'color-relief-color': ['interpolate', ['linear'], ['elevation'], 0, 'green', 100, 'white'] } },
};
for (const method of ['basic', 'combined', 'igor', 'multidirectional']) LAYERS[`hillshade ${method}`] = { type: 'hillshade', source: 'heights', paint: { 'hillshade-method': method } };

async function draw(layer, { projection = 'mercator', terrain = false, sky = false } = {}) {
  const container = Object.assign(document.createElement('div'), { style: 'width:64px;height:64px' });
  document.body.append(container);
  const style = { version: 8, sources: SOURCES, layers: [{ id: 'one', ...layer }], projection: { type: projection }, glyphs: `${location.origin}/nothing/{fontstack}/{range}.pbf`, ...(terrain ? { terrain: { source: 'heights' } } : {}), ...(sky ? { sky: { 'sky-color': '#00f', 'atmosphere-blend': 0.8 } } : {}) };
  const map = new maplibre.Map({ container, style, center: [0, 0], zoom: 2, pitch: 50, attributionControl: false, localIdeographFontFamily: 'sans-serif', fadeDuration: 0, maxPitch: 85 });
  map.on('error', () => {});
  map.on('style.load', () => {
    const data = new Uint8Array(8 * 8 * 4).fill(200);
    for (const [name, sdf] of [['icon', false], ['sdf', true]]) if (!map.hasImage(name)) map.addImage(name, { width: 8, height: 8, data }, { sdf });
  });
  await Promise.race([new Promise((resolve) => map.once('idle', resolve)), wait(2500)]);
  if (sky) {
    map.setPitch(85);
    await wait(200);
  }
  map.remove();
  container.remove();
}

run([
  ...Object.entries(LAYERS).map(([name, layer]) => [name, () => draw(layer)]),
  ...Object.entries(LAYERS).map(([name, layer]) => [`${name}, globe`, () => draw(layer, { projection: 'globe', sky: name === 'fill' })]),
  ...['fill', 'line', 'circle', 'symbol', 'raster', 'heatmap', 'extrusion', 'hillshade'].map((name) => [`${name}, terrain`, () => draw(LAYERS[name], { terrain: true, sky: true })]),
]);
