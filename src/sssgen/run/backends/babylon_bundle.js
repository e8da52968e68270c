// What the page of Babylon.js has of it, as one file: `make setup` bundles it. Emitted modules import some of these files.

export * from '@babylonjs/core/Engines/engine.js';
export * from '@babylonjs/core/Engines/engineStore.js';
export * from '@babylonjs/core/Engines/shaderStore.js';
export * from '@babylonjs/core/Engines/webgpuEngine.js';
export * from '@babylonjs/core/scene.js';
export * from '@babylonjs/core/Cameras/camera.js';
export * from '@babylonjs/core/Lights/directionalLight.js';
export * from '@babylonjs/core/Lights/pointLight.js';
export * from '@babylonjs/core/Lights/spotLight.js';
export * from '@babylonjs/core/Lights/Shadows/cascadedShadowGenerator.js';
export * from '@babylonjs/core/Lights/Shadows/shadowGenerator.js';
export * from '@babylonjs/core/Lights/Shadows/shadowGeneratorSceneComponent.js';
export * from '@babylonjs/core/Materials/materialPluginBase.js';
export * from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
export * from '@babylonjs/core/Materials/Textures/rawCubeTexture.js';
export * from '@babylonjs/core/Materials/Textures/rawTexture.js';
export * from '@babylonjs/core/Materials/Textures/rawTexture2DArray.js';
export * from '@babylonjs/core/Materials/Textures/rawTexture3D.js';
export * from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
export * from '@babylonjs/core/Materials/Textures/texture.js';
export * from '@babylonjs/core/Maths/math.color.js';
export * from '@babylonjs/core/Maths/math.vector.js';
export * from '@babylonjs/core/Meshes/mesh.js';
export * from '@babylonjs/core/Meshes/Builders/boxBuilder.js';
export * from '@babylonjs/core/Meshes/mesh.vertexData.js';
export * from '@babylonjs/core/Misc/decorators.serialization.js';
