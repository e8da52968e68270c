// The scenes: one for each kind of program that three.js makes. Nothing is loaded; textures are computed.

export const SCENES = {
  basic(THREE, renderer) {
    const { scene, camera } = stage(THREE);
    scene.add(new THREE.Mesh(new THREE.BoxGeometry(1.6, 1.6, 1.6), new THREE.MeshBasicMaterial({ color: 0x3377cc })));
    renderer.render(scene, camera);
  },
};

function stage(THREE, background = 0x223344) {
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(40, 4 / 3, 0.1, 50);
  scene.background = new THREE.Color(background);
  camera.position.set(1.5, 1.2, 4.5);
  camera.lookAt(0, 0, 0);
  return { scene, camera };
}
