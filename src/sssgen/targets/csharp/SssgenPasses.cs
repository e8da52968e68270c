// What Unity's URP draws before a material: pictures of the body alone, as the eye or a light sees it. The feature is added
// to the renderer asset, and finds the bodies itself. A picture that a material has already is not drawn.

// The same for all materials: a project has this file once. Made by sssgen.
namespace Sssgen {
    using System.Collections.Generic;
    using UnityEngine;
    using UnityEngine.Rendering.Universal;

    /// <summary>The renderer feature.</summary>
    public sealed class SssgenPasses : ScriptableRendererFeature {
        [Tooltip("The width of a picture of what lights see, in texels")]
        [SerializeField, Range(64, 4096)] private int side = 1024;
        [Tooltip("The seconds between two searches for bodies and lights; their values are read in each frame")]
        [SerializeField, Min(0)] private float searchInterval = 0.5f;

        private readonly List<Body> bodies = new List<Body>();
        private readonly List<Light> lights = new List<Light>();
        private readonly HashSet<Material> warned = new HashSet<Material>();
        private DistanceDrawing distances;
        private LightDrawing reflections;
        private float nextSearch;

        public override void Create() {
            Dispose(true);
            distances = new DistanceDrawing { renderPassEvent = RenderPassEvent.BeforeRendering };
            // after the shadow maps and what else lights read
            reflections = new LightDrawing { renderPassEvent = RenderPassEvent.BeforeRenderingOpaques };
            nextSearch = 0;
        }

        /// <summary>Gives the bodies their pictures: before culling, as a renderer's values are read there.</summary>
        public override void OnCameraPreCull(ScriptableRenderer renderer, in CameraData cameraData) {
            distances.Clear();
            reflections.Clear();
            Camera camera = cameraData.camera;
            if (camera.cameraType == CameraType.Preview) {
                return;
            }
            if (Time.realtimeSinceStartup >= nextSearch) {
                Search();
            }
            RenderTextureDescriptor size = cameraData.cameraTargetDescriptor;
            Plane[] sides = GeometryUtility.CalculateFrustumPlanes(camera);
            View eye = View.OfEye(cameraData.GetViewMatrix(), cameraData.GetProjectionMatrix(), camera.transform.position);
            foreach (Body body in bodies) {
                if (body.IsSeen(camera, sides)) {
                    body.AddPictures(distances, reflections, eye, new Vector2Int(size.width, size.height), lights, side);
                }
            }
        }

        public override void AddRenderPasses(ScriptableRenderer renderer, ref RenderingData renderingData) {
            foreach (Drawing drawing in new Drawing[] { distances, reflections }) {
                if (drawing.HasPictures) {
                    renderer.EnqueuePass(drawing);
                }
            }
        }

        protected override void Dispose(bool disposing) {
            distances?.Dispose();
            reflections?.Dispose();
            distances = null;
            reflections = null;
        }

        /// <summary>Finds the bodies and lights; shaders may have changed, too.</summary>
        private void Search() {
            nextSearch = Time.realtimeSinceStartup + searchInterval;
            var known = new Dictionary<Shader, ShaderNeeds>();
            bodies.Clear();
            foreach (Renderer found in All<Renderer>()) {
                var body = new Body(found, known);
                body.WarnOfMissing(warned);
                if (body.HasPictures) {
                    bodies.Add(body);
                }
            }
            lights.Clear();
            lights.AddRange(All<Light>());
        }

        private static T[] All<T>() where T : Object {
#if UNITY_2022_2_OR_NEWER
            return FindObjectsByType<T>(FindObjectsSortMode.None);
#else
            return FindObjectsOfType<T>();
#endif
        }
    }
}
