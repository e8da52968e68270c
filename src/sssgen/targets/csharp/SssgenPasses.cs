// What Unity's URP draws before a material: pictures of the body alone, as the eye or a light sees it. The feature is added
// to the renderer asset, and finds the bodies itself. A picture that a material has already is not drawn.

// The same for all materials: a project has this file once. Made by sssgen.
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Experimental.Rendering;
using UnityEngine.Rendering;
using UnityEngine.Rendering.Universal;
#if UNITY_6000_0_OR_NEWER
using UnityEngine.Rendering.RenderGraphModule;
#endif

namespace Sssgen {
    /// <summary>The renderer feature.</summary>
    public sealed class SssgenPasses : ScriptableRendererFeature {
        [Tooltip("The width of a picture of what lights see, in texels")]
        [SerializeField, Range(64, 4096)] private int side = 1024;
        [Tooltip("The seconds between two searches for bodies and lights; their values are read in each frame")]
        [SerializeField, Min(0)] private float searchInterval = 0.5f;

        private readonly List<Body> bodies = new List<Body>();
        private readonly List<Light> lights = new List<Light>();
        private PictureDrawing drawing;
        private float nextSearch;

        public override void Create() {
            Dispose(true);
            drawing = new PictureDrawing { renderPassEvent = RenderPassEvent.BeforeRendering };
            nextSearch = 0;
        }

        /// <summary>Gives the bodies their pictures: before culling, as a renderer's values are read there.</summary>
        public override void OnCameraPreCull(ScriptableRenderer renderer, in CameraData cameraData) {
            drawing.Clear();
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
                    body.AddPictures(drawing, eye, new Vector2Int(size.width, size.height), lights, side);
                }
            }
        }

        public override void AddRenderPasses(ScriptableRenderer renderer, ref RenderingData renderingData) {
            if (drawing.HasPictures) {
                renderer.EnqueuePass(drawing);
            }
        }

        protected override void Dispose(bool disposing) {
            drawing?.Dispose();
            drawing = null;
        }

        /// <summary>Finds the bodies and lights; shaders may have changed, too.</summary>
        private void Search() {
            nextSearch = Time.realtimeSinceStartup + searchInterval;
            var known = new Dictionary<Shader, List<ShaderPicture>>();
            bodies.Clear();
            foreach (Renderer found in All<Renderer>()) {
                var body = new Body(found, known);
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

    /// <summary>A picture that a shader needs. Each layer is a pass of the shader, whose tags describe the picture.</summary>
    public sealed class ShaderPicture {
        public readonly string Name;
        public readonly string SeenFrom;
        public readonly int Texture;
        /// <summary>The properties of the matrices from world space to the picture, one for each light.</summary>
        public readonly int[] Views;
        /// <summary>Whether a texel without a surface has the end of the view; else 0.</summary>
        public readonly bool EmptyIsFar;
        /// <summary>The numbers of the passes that draw the layers.</summary>
        public readonly List<int> Layers = new List<int>();

        private ShaderPicture(string name, Shader shader, int pass) {
            Name = name;
            SeenFrom = Tag(shader, pass, "SssgenSeenFrom");
            Texture = Shader.PropertyToID(Tag(shader, pass, "SssgenTexture"));
            string views = Tag(shader, pass, "SssgenViews");
            Views = views == "" ? new int[0] : System.Array.ConvertAll(views.Split(' '), Shader.PropertyToID);
            EmptyIsFar = Tag(shader, pass, "SssgenEmpty") == "far";
        }

        public int Columns => Views.Length > 1 ? 2 : 1;

        public static List<ShaderPicture> Of(Shader shader) {
            var found = new List<ShaderPicture>();
            for (int pass = 0; pass < shader.passCount; pass++) {
                string name = Tag(shader, pass, "SssgenPass");
                if (name == "") {
                    continue;
                }
                ShaderPicture picture = found.Find(other => other.Name == name);
                if (picture == null) {
                    picture = new ShaderPicture(name, shader, pass);
                    found.Add(picture);
                }
                picture.Layers.Add(pass);
            }
            return found;
        }

        private static string Tag(Shader shader, int pass, string name) {
            return shader.FindPassTagValue(pass, new ShaderTagId(name)).name ?? "";
        }
    }

    /// <summary>A renderer with the pictures that its materials need.</summary>
    public sealed class Body {
        private static readonly List<Material> Materials = new List<Material>();
        private readonly Renderer renderer;
        private readonly List<(ShaderPicture picture, Material material)> needs = new List<(ShaderPicture, Material)>();
        private readonly MaterialPropertyBlock values = new MaterialPropertyBlock();
        private readonly int parts;

        /// <param name="known">The pictures of the shaders that were seen before.</param>
        public Body(Renderer renderer, Dictionary<Shader, List<ShaderPicture>> known) {
            this.renderer = renderer;
            renderer.GetSharedMaterials(Materials);
            parts = Materials.Count;
            foreach (Material material in Materials) {
                if (material == null) {
                    continue;
                }
                if (!known.TryGetValue(material.shader, out List<ShaderPicture> pictures)) {
                    known[material.shader] = pictures = ShaderPicture.Of(material.shader);
                }
                foreach (ShaderPicture picture in pictures) {
                    if (!needs.Exists(need => need.picture.Texture == picture.Texture)) {
                        needs.Add((picture, material));
                    }
                }
            }
        }

        public bool HasPictures => needs.Count > 0;

        public bool IsSeen(Camera camera, Plane[] sides) {
            return renderer != null && renderer.enabled && renderer.gameObject.activeInHierarchy
                && (camera.cullingMask & (1 << renderer.gameObject.layer)) != 0
                && GeometryUtility.TestPlanesAABB(sides, renderer.bounds);
        }

        /// <summary>Adds what is drawn for a camera, and sets the pictures and their views.</summary>
        public void AddPictures(PictureDrawing drawing, View eye, Vector2Int size, List<Light> lights, int side) {
            renderer.GetPropertyBlock(values);
            foreach (var need in needs) {
                ShaderPicture picture = need.picture;
                Material material = need.material;
                if (material == null || material.GetTexture(picture.Texture) != null) {
                    continue;
                }
                bool byEye = picture.SeenFrom == "eye";
                var views = new List<View>();
                if (byEye) {
                    views.Add(eye);
                } else {
                    bool distant = picture.SeenFrom == "distant light";
                    foreach (Light light in Lamps.Brightest(lights, renderer.bounds, distant, picture.Views.Length)) {
                        views.Add(View.OfLight(light, renderer.bounds, distant));
                    }
                }
                for (int i = 0; i < picture.Views.Length; i++) {
                    // a view of zeros shows nothing
                    values.SetMatrix(picture.Views[i], i < views.Count ? views[i].InTile(i, picture.Columns) : Matrix4x4.zero);
                }
                float gap = 1e-3f * renderer.bounds.extents.magnitude;
                var shown = new Shown {
                    Renderer = renderer, Parts = parts, Material = material, Picture = picture, Views = views, Gap = gap,
                };
                // the eye sees all bodies in one picture: where bodies are beside each other, the nearest back face is
                // that of the visible one
                values.SetTexture(picture.Texture, drawing.Add(shown, byEye ? size : new Vector2Int(side, side), byEye));
            }
            renderer.SetPropertyBlock(values);
        }
    }

    /// <summary>The lights of a body.</summary>
    public static class Lamps {
        /// <summary>The lights that are brightest at a box, at most `count`; `distant`: those from afar, if any.</summary>
        public static List<Light> Brightest(List<Light> lights, Bounds box, bool distant, int count) {
            var found = new List<Light>();
            var strengths = new List<float>();
            distant = distant && lights.Exists(light => IsLit(light, box) && light.type == LightType.Directional);
            foreach (Light light in lights) {
                if (IsLit(light, box) && (!distant || light.type == LightType.Directional)) {
                    float strength = Strength(light, box);
                    // behind those that are as bright, so that the order stays
                    int place = strengths.FindIndex(other => other < strength);
                    place = place < 0 ? found.Count : place;
                    found.Insert(place, light);
                    strengths.Insert(place, strength);
                }
            }
            return found.GetRange(0, Mathf.Min(count, found.Count));
        }

        private static bool IsLit(Light light, Bounds box) {
            return light != null && light.isActiveAndEnabled && Strength(light, box) > 0;
        }

        /// <summary>The irradiance at the middle of a box, as URP lets light fall off; 0 where no light reaches it.</summary>
        private static float Strength(Light light, Bounds box) {
            float strength = light.intensity * light.color.linear.maxColorComponent;
            if (light.type == LightType.Directional) {
                return strength;
            }
            Vector3 way = box.center - light.transform.position;
            float away = Mathf.Max(way.magnitude, 1e-3f);
            if (light.type == LightType.Spot) {
                float half = Mathf.Rad2Deg * Mathf.Asin(Mathf.Min(box.extents.magnitude / away, 1));
                if (Vector3.Angle(light.transform.forward, way) - half > 0.5f * light.spotAngle && half < 90) {
                    return 0;
                }
            } else if (light.type != LightType.Point) {
                return 0;
            }
            float share = Mathf.Pow(away / light.range, 4);
            return strength * Mathf.Pow(Mathf.Max(1 - share, 0), 2) / (away * away);
        }
    }

    /// <summary>How the eye or a light sees a body.</summary>
    public struct View {
        /// <summary>The width of a light's picture relative to the body.</summary>
        private const float Margin = 1.1f;

        public Matrix4x4 Camera;
        public Matrix4x4 Projection;
        public Vector3 Eye;
        /// <summary>Its product with a place is the distance from the plane in front of a light.</summary>
        public Vector4 Plane;
        /// <summary>The largest distance from this plane. A larger one would spread where a filter blends texels.</summary>
        public float End;

        public static View OfEye(Matrix4x4 camera, Matrix4x4 projection, Vector3 eye) {
            return new View { Camera = camera, Projection = projection, Eye = eye };
        }

        /// <summary>All of a box from a light; `distant`: as if the light were far away.</summary>
        public static View OfLight(Light light, Bounds box, bool distant) {
            if (light.type == LightType.Directional) {
                return FromAfar(light.transform.forward, box);
            }
            Vector3 way = box.center - light.transform.position;
            return distant ? FromAfar(way.normalized, box) : FromPoint(light.transform.position, way, box);
        }

        private static View FromAfar(Vector3 ahead, Bounds box) {
            Axes(ahead, out Vector3 right, out Vector3 up);
            float wide = 2 * Margin * Mathf.Max(Extent(box, right), Extent(box, up));
            float deep = Extent(box, ahead);
            Vector3 place = box.center - ahead * (deep + 0.1f * wide);
            float half = 0.5f * wide;
            float end = 2 * deep + 0.2f * wide;
            return new View(place, right, up, ahead, Matrix4x4.Ortho(-half, half, -half, half, 0, end), end);
        }

        private static View FromPoint(Vector3 place, Vector3 way, Bounds box) {
            float distance = Mathf.Max(way.magnitude, 1e-4f);
            Vector3 ahead = way.sqrMagnitude > 0 ? way.normalized : Vector3.forward;
            Axes(ahead, out Vector3 right, out Vector3 up);
            float slope = 0, near = distance, far = distance;
            for (int i = 0; i < 8; i++) {
                var corner = new Vector3((i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1);
                Vector3 local = box.center + Vector3.Scale(box.extents, corner) - place;
                float depth = Vector3.Dot(local, ahead);
                near = Mathf.Min(near, depth);
                far = Mathf.Max(far, depth);
                // what is beside a lamp in the box is not seen
                float across = Mathf.Max(Mathf.Abs(Vector3.Dot(local, right)), Mathf.Abs(Vector3.Dot(local, up)));
                slope = Mathf.Max(slope, across / Mathf.Max(depth, 0.1f * distance));
            }
            near = Mathf.Max(0.99f * near, 0.01f * distance);
            float half = Margin * slope * near;
            float end = 1.01f * far;
            return new View(place, right, up, ahead, Matrix4x4.Frustum(-half, half, -half, half, near, end), end);
        }

        private View(Vector3 place, Vector3 right, Vector3 up, Vector3 ahead, Matrix4x4 projection, float end) {
            Camera = Matrix4x4.identity;
            Camera.SetRow(0, Row(right, place));
            Camera.SetRow(1, Row(up, place));
            Camera.SetRow(2, Row(-ahead, place));
            Projection = projection;
            Eye = place;
            Plane = Row(ahead, place);
            End = end;
        }

        /// <summary>World space to (u w, v w, distance from the plane, w) in a tile of the picture.</summary>
        public Matrix4x4 InTile(int tile, int columns) {
            Matrix4x4 clip = Projection * Camera;
            Vector4 w = clip.GetRow(3);
            var result = new Matrix4x4();
            result.SetRow(0, ((tile % columns + 0.5f) * w + 0.5f * clip.GetRow(0)) / columns);
            result.SetRow(1, ((tile / columns + 0.5f) * w + 0.5f * clip.GetRow(1)) / columns);
            result.SetRow(2, Plane);
            result.SetRow(3, w);
            return result;
        }

        private static Vector4 Row(Vector3 axis, Vector3 place) {
            return new Vector4(axis.x, axis.y, axis.z, -Vector3.Dot(axis, place));
        }

        private static float Extent(Bounds box, Vector3 axis) {
            Vector3 half = box.extents;
            return Mathf.Abs(axis.x) * half.x + Mathf.Abs(axis.y) * half.y + Mathf.Abs(axis.z) * half.z;
        }

        private static void Axes(Vector3 ahead, out Vector3 right, out Vector3 up) {
            float x = Mathf.Abs(ahead.x), y = Mathf.Abs(ahead.y), z = Mathf.Abs(ahead.z);
            Vector3 least = x <= y && x <= z ? Vector3.right : y <= z ? Vector3.up : Vector3.forward;
            right = Vector3.Cross(ahead, least).normalized;
            up = Vector3.Cross(ahead, right);
        }
    }

    /// <summary>A body in a picture.</summary>
    public struct Shown {
        public Renderer Renderer;
        public int Parts;
        public Material Material;
        public ShaderPicture Picture;
        public List<View> Views;
        /// <summary>The least distance between two layers.</summary>
        public float Gap;
    }

    /// <summary>Draws the pictures of a camera. They are kept until the next camera is drawn.</summary>
    public sealed class PictureDrawing : ScriptableRenderPass {
#if UNITY_2023_2_OR_NEWER
        private const GraphicsFormatUsage Filtered = GraphicsFormatUsage.Linear;
#else
        private const FormatUsage Filtered = FormatUsage.Linear;
#endif
        private static readonly int Clip = Shader.PropertyToID("_SssgenClip");
        private static readonly int Eye = Shader.PropertyToID("_SssgenEye");
        private static readonly int Plane = Shader.PropertyToID("_SssgenPlane");
        private static readonly int Gap = Shader.PropertyToID("_SssgenGap");
        private static readonly int Before = Shader.PropertyToID("_SssgenBefore");
        private readonly List<(RenderTexture texture, List<Shown> bodies)> pictures = new List<(RenderTexture, List<Shown>)>();
        private readonly Dictionary<string, int> shared = new Dictionary<string, int>();
        private readonly List<RenderTexture> lent = new List<RenderTexture>();

        public bool HasPictures => pictures.Count > 0;

        /// <summary>The texture in which a body will be shown; `together`: with all bodies that have such a picture.</summary>
        public RenderTexture Add(Shown body, Vector2Int size, bool together) {
            if (together && shared.TryGetValue(body.Picture.Name, out int place)) {
                pictures[place].bodies.Add(body);
                return pictures[place].texture;
            }
            bool several = body.Picture.Layers.Count > 1;
            RenderTexture texture = Texture(size, several ? RenderTextureFormat.ARGBFloat : RenderTextureFormat.RFloat, 32);
            if (!together && SystemInfo.IsFormatSupported(texture.graphicsFormat, Filtered)) {
                texture.filterMode = FilterMode.Bilinear;
            }
            if (together) {
                shared[body.Picture.Name] = pictures.Count;
            }
            pictures.Add((texture, new List<Shown> { body }));
            return texture;
        }

        public void Clear() {
            lent.ForEach(RenderTexture.ReleaseTemporary);
            lent.Clear();
            pictures.Clear();
            shared.Clear();
        }

        private RenderTexture Texture(Vector2Int size, RenderTextureFormat format, int depth) {
            RenderTexture texture = RenderTexture.GetTemporary(size.x, size.y, depth, format, RenderTextureReadWrite.Linear);
            texture.filterMode = FilterMode.Point;
            texture.wrapMode = TextureWrapMode.Clamp;
            lent.Add(texture);
            return texture;
        }

        private void Draw(CommandBuffer commands) {
            RenderTexture before = null;
            foreach (var drawn in pictures) {
                RenderTexture texture = drawn.texture;
                ShaderPicture picture = drawn.bodies[0].Picture;
                float end = 0;
                if (picture.EmptyIsFar) {
                    drawn.bodies[0].Views.ForEach(view => end = Mathf.Max(end, view.End));
                }
                var empty = new Color(end, end, end, end);
                if (picture.Layers.Count > 2 && (before == null || before.width != texture.width)) {
                    before = Texture(new Vector2Int(texture.width, texture.height), texture.format, 0);
                }
                for (int layer = 0; layer < picture.Layers.Count; layer++) {
                    if (layer > 1) { // the first of either side has none before it
                        commands.CopyTexture(texture, before);
                        commands.SetGlobalTexture(Before, before);
                    }
                    commands.SetRenderTarget(texture);
                    commands.ClearRenderTarget(true, layer == 0, empty);
                    foreach (Shown body in drawn.bodies) {
                        DrawLayer(commands, body, layer, texture.width, texture.height);
                    }
                }
            }
        }

        private static void DrawLayer(CommandBuffer commands, Shown body, int layer, int width, int height) {
            int columns = body.Picture.Columns;
            width /= columns;
            height /= columns;
            commands.SetGlobalFloat(Gap, body.Gap);
            for (int i = 0; i < body.Views.Count; i++) {
                View view = body.Views[i];
                commands.SetViewport(new Rect(i % columns * width, i / columns * height, width, height));
                commands.SetGlobalMatrix(Clip, GL.GetGPUProjectionMatrix(view.Projection, true) * view.Camera);
                commands.SetGlobalVector(Eye, view.Eye);
                commands.SetGlobalVector(Plane, view.Plane);
                for (int part = 0; part < body.Parts; part++) {
                    commands.DrawRenderer(body.Renderer, body.Material, part, body.Picture.Layers[layer]);
                }
            }
        }

#if UNITY_6000_0_OR_NEWER
        private sealed class Data {
            public PictureDrawing Drawing;
        }

        public override void RecordRenderGraph(RenderGraph graph, ContextContainer frame) {
            using (IUnsafeRenderGraphBuilder builder = graph.AddUnsafePass("sssgen", out Data data)) {
                data.Drawing = this;
                builder.AllowPassCulling(false); // the graph does not know who reads the pictures
                builder.AllowGlobalStateModification(true);
                builder.SetRenderFunc((Data own, UnsafeGraphContext context) =>
                    own.Drawing.Draw(CommandBufferHelpers.GetNativeCommandBuffer(context.cmd)));
            }
        }
#endif
#if !UNITY_6000_0_OR_NEWER || URP_COMPATIBILITY_MODE
        // URP takes this for the target that is bound, so that the next pass binds its own again
        private readonly RTHandle apart = RTHandles.Alloc(new RenderTexture(1, 1, 0));

#if UNITY_6000_0_OR_NEWER
        [System.Obsolete]
#endif
        public override void OnCameraSetup(CommandBuffer commands, ref RenderingData data) {
            ConfigureTarget(apart);
        }

#if UNITY_6000_0_OR_NEWER
        [System.Obsolete]
#endif
        public override void Execute(ScriptableRenderContext context, ref RenderingData data) {
            CommandBuffer commands = CommandBufferPool.Get("sssgen");
            Draw(commands);
            context.ExecuteCommandBuffer(commands);
            CommandBufferPool.Release(commands);
        }
#endif

        public void Dispose() {
            Clear();
#if !UNITY_6000_0_OR_NEWER || URP_COMPATIBILITY_MODE
            RenderTexture texture = apart.rt;
            apart.Release();
            CoreUtils.Destroy(texture);
#endif
        }
    }
}
