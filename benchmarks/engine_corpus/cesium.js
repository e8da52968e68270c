// CesiumJS: globe and sky, primitives with each material and appearance, billboards, labels, clouds, post processes.

import { canvas, picture, run, wait } from './pages_common.js';

window.CESIUM_BASE_URL = '/packages/node_modules/cesium/Build/Cesium/';
const Cesium = await import(`${location.origin}/packages/node_modules/cesium/Build/Cesium/index.js`);

const element = canvas(64, 64);
let scene;
const clock = Cesium.JulianDate.fromIso8601('2024-06-01T12:00:00Z');
const place = Cesium.Cartesian3.fromDegrees(10, 45, 1000);
const rectangle = () => Cesium.Rectangle.fromDegrees(9, 44, 11, 46);

async function frames(count = 4) {
  for (let index = 0; index < count; index++) {
    scene.initializeFrame();
    scene.render(clock);
    await wait(10);
  }
}

function begin(options = {}) {
  scene?.destroy();
  scene = new Cesium.Scene({ canvas: canvas(64, 64), contextOptions: { requestWebgl1: false }, ...options });
  scene.camera.setView({ destination: Cesium.Cartesian3.fromDegrees(10, 45, 4e5) });
  scene.backgroundColor = Cesium.Color.BLACK;
}

async function globe(change) {
  begin();
  scene.globe = new Cesium.Globe(Cesium.Ellipsoid.WGS84);
  scene.skyAtmosphere = new Cesium.SkyAtmosphere();
  scene.sun = new Cesium.Sun();
  scene.moon = new Cesium.Moon();
  scene.globe.imageryLayers.add(new Cesium.ImageryLayer(await Cesium.SingleTileImageryProvider.fromUrl(picture)));
  await change?.(scene.globe);
  await frames(12);
}

async function primitive(change) {
  begin();
  await change(scene.primitives);
  await frames();
}

const shape = (appearance, attributes = {}, geometry = new Cesium.RectangleGeometry({ rectangle: rectangle(), vertexFormat: appearance.vertexFormat ?? Cesium.VertexFormat.ALL })) => new Cesium.Primitive({ asynchronous: false, geometryInstances: new Cesium.GeometryInstance({ geometry, attributes }), appearance });
const materials = ['Color', 'Image', 'DiffuseMap', 'AlphaMap', 'SpecularMap', 'EmissionMap', 'BumpMap', 'NormalMap', 'Grid', 'Stripe', 'Checkerboard', 'Dot', 'Water', 'RimLighting', 'Fade', 'ElevationContour', 'ElevationRamp', 'SlopeRamp', 'AspectRamp', 'ElevationBand', 'WaterMask'];
const lineMaterials = ['Color', 'PolylineArrow', 'PolylineDash', 'PolylineGlow', 'PolylineOutline'];
const color = () => Cesium.ColorGeometryInstanceAttribute.fromColor(Cesium.Color.RED);
const line = (vertexFormat) => new Cesium.PolylineGeometry({ positions: Cesium.Cartesian3.fromDegreesArray([9, 44, 11, 46, 12, 44]), width: 4, vertexFormat });
const of = (type) => Cesium.Material.fromType(type);

const GLOBES = {
  plain: null, lighting: (one) => { one.enableLighting = true; one.dynamicAtmosphereLighting = true; }, water: (one) => { one.showWaterEffect = true; one.oceanNormalMapUrl = picture; }, 'ground atmosphere off': (one) => { one.showGroundAtmosphere = false; }, fog: () => { scene.fog.enabled = true; scene.camera.setView({ destination: Cesium.Cartesian3.fromDegrees(10, 45, 500), orientation: { pitch: 0 } }); },
  translucency: (one) => { one.translucency.enabled = true; one.translucency.frontFaceAlpha = 0.5; }, 'clipping planes': (one) => { one.clippingPlanes = new Cesium.ClippingPlaneCollection({ planes: [new Cesium.ClippingPlane(new Cesium.Cartesian3(1, 0, 0), 0)] }); }, 'contour lines': (one) => { one.material = of('ElevationContour'); }, 'imagery settings': (one) => { const layer = one.imageryLayers.get(0); Object.assign(layer, { brightness: 1.2, contrast: 1.1, hue: 0.2, saturation: 0.8, gamma: 1.2, alpha: 0.7 }); layer.colorToAlpha = Cesium.Color.WHITE; layer.splitDirection = Cesium.SplitDirection.LEFT; },
  'sky per fragment': () => { scene.skyAtmosphere.perFragmentAtmosphere = true; }, 'high range': () => { scene.highDynamicRange = true; }, 'vertical exaggeration': () => { scene.verticalExaggeration = 2; }, shadows: (one) => { one.shadows = Cesium.ShadowMode.ENABLED; scene.shadowMap = new Cesium.ShadowMap({ context: scene.context, lightCamera: scene.camera }); scene.shadowMap.enabled = true; }, '2D': () => { scene.morphTo2D(0); }, Columbus: () => { scene.morphToColumbusView(0); }, 'translucent objects': () => { scene.orderIndependentTranslucency = true; }, 'under ground colour': (one) => { one.undergroundColor = Cesium.Color.RED; scene.camera.setView({ destination: Cesium.Cartesian3.fromDegrees(10, 45, -500) }); }, 'cartographic limit': (one) => { one.cartographicLimitRectangle = rectangle(); },
};
const PRIMITIVES = {
  'colour per instance': (all) => all.add(shape(new Cesium.PerInstanceColorAppearance(), { color: color() })), 'flat colour': (all) => all.add(shape(new Cesium.PerInstanceColorAppearance({ flat: true, translucent: false }), { color: color() })), surface: (all) => all.add(shape(new Cesium.EllipsoidSurfaceAppearance({ aboveGround: true }))),
  billboards: (all) => { const one = all.add(new Cesium.BillboardCollection({ scene })); one.add({ position: place, image: picture, scaleByDistance: new Cesium.NearFarScalar(1, 2, 1e6, 0.5), rotation: 1 }); }, 'billboards, all': (all) => { const one = all.add(new Cesium.BillboardCollection({ scene })); one.add({ position: place, image: picture, heightReference: 0, sizeInMeters: true, translucencyByDistance: new Cesium.NearFarScalar(1, 1, 1e6, 0), pixelOffsetScaleByDistance: new Cesium.NearFarScalar(1, 1, 1e6, 0), distanceDisplayCondition: new Cesium.DistanceDisplayCondition(1, 1e7), disableDepthTestDistance: 10, splitDirection: 1, alignedAxis: Cesium.Cartesian3.UNIT_Z }); }, labels: (all) => all.add(new Cesium.LabelCollection({ scene })).add({ position: place, text: 'text', style: 2, showBackground: true }),
  points: (all) => all.add(new Cesium.PointPrimitiveCollection()).add({ position: place, pixelSize: 5, outlineWidth: 1 }), 'points, all': (all) => all.add(new Cesium.PointPrimitiveCollection()).add({ position: place, pixelSize: 5, scaleByDistance: new Cesium.NearFarScalar(1, 1, 1e6, 0), translucencyByDistance: new Cesium.NearFarScalar(1, 1, 1e6, 0), distanceDisplayCondition: new Cesium.DistanceDisplayCondition(1, 1e7), disableDepthTestDistance: 10 }),
  ellipsoid: (all) => all.add(new Cesium.EllipsoidPrimitive({ center: place, radii: new Cesium.Cartesian3(1e4, 1e4, 1e4), material: of('Color') })), 'axis of debugging': (all) => all.add(new Cesium.DebugModelMatrixPrimitive({ length: 1e4 })), particles: (all) => all.add(new Cesium.ParticleSystem({ image: picture, emissionRate: 50, emitter: new Cesium.CircleEmitter(1), modelMatrix: Cesium.Transforms.eastNorthUpToFixedFrame(place) })), 'viewport quad': (all) => all.add(new Cesium.ViewportQuad(new Cesium.BoundingRectangle(0, 0, 8, 8), of('Grid'))), viewport: (all) => all.add(new Cesium.ViewportQuad(new Cesium.BoundingRectangle(0, 0, 8, 8), of('Color'))),
  'line colours': (all) => all.add(shape(new Cesium.PolylineColorAppearance(), { color: color() }, line(Cesium.PolylineColorAppearance.VERTEX_FORMAT))), outline: (all) => all.add(shape(new Cesium.PerInstanceColorAppearance({ flat: true }), { color: color() }, new Cesium.RectangleOutlineGeometry({ rectangle: rectangle() }))), box: (all) => all.add(shape(new Cesium.MaterialAppearance({ materialSupport: Cesium.MaterialAppearance.MaterialSupport.BASIC }), {}, Cesium.BoxGeometry.fromDimensions({ dimensions: place, vertexFormat: Cesium.VertexFormat.POSITION_AND_NORMAL }))), debug: (all) => all.add(shape(new Cesium.DebugAppearance({ attributeName: 'normal' }))), 'ground primitive': async (all) => { scene.globe = new Cesium.Globe(); await Cesium.GroundPrimitive.initializeTerrainHeights(); all.add(new Cesium.GroundPrimitive({ asynchronous: false, geometryInstances: new Cesium.GeometryInstance({ geometry: new Cesium.RectangleGeometry({ rectangle: rectangle() }), attributes: { color: color() } }) })); await frames(10); }, 'classification of lines': async (all) => { scene.globe = new Cesium.Globe(); await Cesium.GroundPolylinePrimitive.initializeTerrainHeights(); all.add(new Cesium.GroundPolylinePrimitive({ asynchronous: false, geometryInstances: new Cesium.GeometryInstance({ geometry: new Cesium.GroundPolylineGeometry({ positions: Cesium.Cartesian3.fromDegreesArray([9, 44, 11, 46]), width: 4 }), attributes: { color: color() } }), appearance: new Cesium.PolylineColorAppearance() })); await frames(10); },
  'voxel box': (all) => all.add(new Cesium.VoxelPrimitive({})), 'cube map panorama': () => { scene.skyBox = new Cesium.SkyBox({ sources: Object.fromEntries(['positiveX', 'negativeX', 'positiveY', 'negativeY', 'positiveZ', 'negativeZ'].map((side) => [side, picture])) }); },
};

// A triangle in glTF, with what makes variants of the model's shader.
function gltf({ material = {}, extensions = [], attributes = {}, pieces = [] } = {}) {
  const floats = [0, 0, 0, 1e4, 0, 0, 0, 1e4, 0, ...Array(200).fill(0.5)];
  const uri = `data:application/octet-stream;base64,${btoa(String.fromCharCode(...new Uint8Array(new Float32Array(floats).buffer)))}`;
  const accessor = (type, count = 3) => ({ bufferView: 0, componentType: 5126, count, type, ...(type === 'VEC3' ? { min: [0, 0, 0], max: [1e4, 1e4, 1] } : {}) });
  return { asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], buffers: [{ uri, byteLength: floats.length * 4 }], bufferViews: [{ buffer: 0, byteLength: floats.length * 4, target: 34962 }],
    accessors: [accessor('VEC3'), accessor('VEC2'), accessor('VEC4')], images: [{ uri: picture }], textures: [{ source: 0 }], materials: [material], extensionsUsed: extensions, meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 0, TEXCOORD_0: 1, ...attributes }, material: 0, ...Object.assign({}, ...pieces) }] }] };
}
const map = { index: 0 };
const MODELS = {
  plain: {}, maps: { material: { pbrMetallicRoughness: { baseColorTexture: map, metallicRoughnessTexture: map }, normalTexture: map, occlusionTexture: map, emissiveTexture: map } }, unlit: { material: { extensions: { KHR_materials_unlit: {} } }, extensions: ['KHR_materials_unlit'] }, mask: { material: { alphaMode: 'MASK', doubleSided: true } }, blend: { material: { alphaMode: 'BLEND' } }, colours: { attributes: { COLOR_0: 2 } }, tangents: { attributes: { TANGENT: 2 }, material: { normalTexture: map } }, points: { pieces: [{ mode: 0 }] }, morph: { pieces: [{ targets: [{ POSITION: 0 }] }] },
  specular: { material: { extensions: { KHR_materials_specular: { specularFactor: 0.5 } } }, extensions: ['KHR_materials_specular'] }, clearcoat: { material: { extensions: { KHR_materials_clearcoat: { clearcoatFactor: 1, clearcoatTexture: map } } }, extensions: ['KHR_materials_clearcoat'] }, anisotropy: { material: { extensions: { KHR_materials_anisotropy: { anisotropyStrength: 0.5 } } }, extensions: ['KHR_materials_anisotropy'], attributes: { TANGENT: 2 } }, 'texture transform': { material: { pbrMetallicRoughness: { baseColorTexture: { index: 0, extensions: { KHR_texture_transform: { scale: [2, 2] } } } } }, extensions: ['KHR_texture_transform'] },
};
const MODEL_OPTIONS = {
  silhouette: { silhouetteSize: 2 }, tint: { colorBlendMode: 1, color: 'RED' }, shadows: { shadows: 1 }, clipping: { clippingPlanes: () => new Cesium.ClippingPlaneCollection({ planes: [new Cesium.ClippingPlane(new Cesium.Cartesian3(1, 0, 0), 0)] }) }, 'custom shader': { customShader: () => new Cesium.CustomShader({ uniforms: { u_t: { type: 'float', value: 1 } }, varyings: { v_x: 'vec3' }, vertexShaderText: 'void vertexMain(VertexInput vsInput, inout czm_modelVertexOutput vsOutput) { v_x = vsInput.attributes.positionMC; vsOutput.positionMC *= u_t; }', fragmentShaderText: 'void fragmentMain(FragmentInput fsInput, inout czm_modelMaterial material) { material.diffuse = fract(v_x); }' }) },
};
async function model(content, options = {}) {
  begin();
  const values = Object.fromEntries(Object.entries(options).map(([name, value]) => [name, name === 'color' ? Cesium.Color[value] : typeof value === 'function' ? value() : value]));
  const one = await Cesium.Model.fromGltfAsync({ gltf: gltf(content), modelMatrix: Cesium.Transforms.eastNorthUpToFixedFrame(place), asynchronous: false, incrementallyLoadTextures: false, ...values });
  scene.primitives.add(one);
  await frames(30);
}
const STAGES = {
  ambientOcclusion: () => Cesium.PostProcessStageLibrary.createAmbientOcclusionStage?.(), bloom: () => { scene.postProcessStages.bloom.enabled = true; }, fxaa: () => { scene.postProcessStages.fxaa.enabled = true; }, ssao: () => { scene.postProcessStages.ambientOcclusion.enabled = true; },
  ...Object.fromEntries(['BlackAndWhite', 'Blur', 'Brightness', 'DepthOfField', 'DepthView', 'EdgeDetection', 'LensFlare', 'NightVision', 'Silhouette'].map((name) => [name, () => Cesium.PostProcessStageLibrary[`create${name}Stage`]()])),
};
const steps = [];
for (const [name, change] of Object.entries(PRIMITIVES)) steps.push([name, () => primitive(change)]);
for (const type of materials) {
  steps.push([`material ${type}`, () => primitive((all) => all.add(shape(new Cesium.MaterialAppearance({ material: of(type), materialSupport: Cesium.MaterialAppearance.MaterialSupport.ALL }))))]);
  steps.push([`surface ${type}`, () => primitive((all) => all.add(shape(new Cesium.EllipsoidSurfaceAppearance({ material: of(type) }))))]);
}
for (const type of lineMaterials) {
  steps.push([`line ${type}`, () => primitive((all) => all.add(shape(new Cesium.PolylineMaterialAppearance({ material: of(type) }), {}, line(Cesium.PolylineMaterialAppearance.VERTEX_FORMAT))))]);
  steps.push([`lines ${type}`, () => primitive((all) => all.add(new Cesium.PolylineCollection()).add({ positions: Cesium.Cartesian3.fromDegreesArray([9, 44, 11, 46]), width: 3, material: of(type) }))]);
}
for (const [name, content] of Object.entries(MODELS)) steps.push([`model ${name}`, () => model(content)]);
for (const [name, options] of Object.entries(MODEL_OPTIONS)) steps.push([`model, ${name}`, () => model(MODELS.maps, options)]);
for (const [name, make] of Object.entries(STAGES)) {
  steps.push([`stage ${name}`, () => primitive(async (all) => {
    all.add(shape(new Cesium.PerInstanceColorAppearance(), { color: color() }));
    const stage = make();
    if (stage) scene.postProcessStages.add(stage);
    await frames(8);
  })]);
}
for (const name of Object.keys(Cesium.Tonemapper).filter((key) => key !== 'validate')) steps.push([`tone mapping ${name}`, () => primitive(async () => { scene.highDynamicRange = true; scene.postProcessStages.tonemapper = Cesium.Tonemapper[name]; await frames(4); })]);
for (const [name, change] of Object.entries(GLOBES)) steps.push([`globe ${name}`, () => globe(change)]);

element.remove();
run(steps);
