// Stand-in, written for sssgen: what SssgenPasses.cs uses of Unity's render pipelines, under the names of each version. A
// command buffer keeps its commands as rows: a word and its numbers.
using System;
using System.Collections.Generic;

namespace UnityEngine.Rendering {
    public struct ShaderTagId {
        public string name { get; }
        public ShaderTagId(string name) { this.name = name; }
    }

    public struct RenderTargetIdentifier {
        public RenderTexture Texture;
        public static implicit operator RenderTargetIdentifier(Texture texture) =>
            new RenderTargetIdentifier { Texture = (RenderTexture)texture };
    }

    public sealed class CommandBuffer {
        public readonly List<object[]> Rows = new List<object[]>();
        public void CopyTexture(RenderTargetIdentifier from, RenderTargetIdentifier to) => Add("copy", from.Texture, to.Texture);
        public void SetRenderTarget(RenderTargetIdentifier target) => Add("target", target.Texture);
        public void ClearRenderTarget(bool depth, bool color, Color value) => Add("clear", depth, color, value.r, value.g, value.b, value.a);
        public void SetViewport(Rect place) => Add("viewport", place.x, place.y, place.width, place.height);
        public void SetGlobalFloat(int name, float value) => Add("set", name, value);
        public void SetGlobalVector(int name, Vector4 value) => Add("set", name, value);
        public void SetGlobalMatrix(int name, Matrix4x4 value) => Add("set", name, value);
        public void SetGlobalTexture(int name, RenderTargetIdentifier value) => Add("texture", name, value.Texture);
        public void DrawRenderer(Renderer renderer, Material material, int part, int pass) => Add("draw", renderer, part, pass);
#if UNITY_6000_0_OR_NEWER
        public void DrawRendererList(RendererList list) => list.Of.DrawInto(this);
#endif
        public void Clear() => Rows.Clear();
        private void Add(params object[] row) => Rows.Add(row);
    }

    public sealed class ScriptableRenderContext {
        public readonly CommandBuffer Done = new CommandBuffer();
        public void ExecuteCommandBuffer(CommandBuffer commands) => Done.Rows.AddRange(commands.Rows);
#if UNITY_6000_0_OR_NEWER
        public RendererList CreateRendererList(ref RendererListParams list) => new RendererList { Of = list };
#else
        public void DrawRenderers(CullingResults seen, ref DrawingSettings settings, ref FilteringSettings filter) =>
            new RendererListParams(seen, settings, filter).DrawInto(Done);
#endif
    }

    // What the camera sees, drawn as URP does: each body with its own lights, with the pass of a LightMode.
    public enum SortingCriteria { CommonOpaque = 59 }
    public struct RenderQueueRange { public static RenderQueueRange all => new RenderQueueRange(); }
    public struct CullingResults { }
    public struct DrawingSettings { public ShaderTagId Pass; }
    public struct FilteringSettings {
        public bool All;
        public FilteringSettings(RenderQueueRange? range = null) { All = range != null; }
    }
    public struct RendererListParams {
        private DrawingSettings settings;
        public RendererListParams(CullingResults seen, DrawingSettings settings, FilteringSettings filter) {
            if (!filter.All) throw new InvalidOperationException("no bodies");
            this.settings = settings;
        }
        internal void DrawInto(CommandBuffer commands) => commands.Rows.Add(new object[] { "bodies", settings.Pass.name });
    }
#if UNITY_6000_0_OR_NEWER
    public struct RendererList { public RendererListParams Of; }
#endif

    public static class CommandBufferPool {
        public static CommandBuffer Get(string name) => new CommandBuffer();
        public static void Release(CommandBuffer commands) { }
    }
    public enum LightProbeUsage { Off = 0, BlendProbes = 1 }
    public struct SphericalHarmonicsL2 {
        private float[] numbers;
        /// <summary>By channel and number.</summary>
        public float this[int channel, int number] {
            get => numbers == null ? 0 : numbers[9 * channel + number];
            set => (numbers = numbers ?? new float[27])[9 * channel + number] = value;
        }
    }
    public static class CoreUtils {
        public static void Destroy(Object one) { }
    }
    public sealed class RTHandle {
        public RenderTexture rt;
        public void Release() { rt = null; }
        public static implicit operator RenderTargetIdentifier(RTHandle handle) => handle.rt;
    }
    public static class RTHandles {
        public static RTHandle Alloc(RenderTexture texture) => new RTHandle { rt = texture };
    }
#if UNITY_6000_0_OR_NEWER
    public sealed class ContextContainer { public T Get<T>() where T : new() => new T(); }
    public sealed class UnsafeCommandBuffer { public readonly CommandBuffer Own = new CommandBuffer(); }
    public static class CommandBufferHelpers {
        public static CommandBuffer GetNativeCommandBuffer(UnsafeCommandBuffer commands) => commands.Own;
    }
#endif
}

#if UNITY_6000_0_OR_NEWER
namespace UnityEngine.Rendering.RenderGraphModule {
    public delegate void BaseRenderFunc<Data, Context>(Data data, Context context) where Data : class, new();
    public struct RendererListHandle {
        public RendererListParams Of;
        public static implicit operator RendererList(RendererListHandle list) => new RendererList { Of = list.Of };
    }
    public sealed class UnsafeGraphContext { public UnsafeCommandBuffer cmd = new UnsafeCommandBuffer(); }
    public interface IUnsafeRenderGraphBuilder : IDisposable {
        void AllowPassCulling(bool value);
        void AllowGlobalStateModification(bool value);
        void UseAllGlobalTextures(bool value);
        void UseRendererList(in RendererListHandle list);
        void SetRenderFunc<Data>(BaseRenderFunc<Data, UnsafeGraphContext> function) where Data : class, new();
    }
    public sealed class RenderGraph {
        public readonly CommandBuffer Done = new CommandBuffer();
        public RendererListHandle CreateRendererList(in RendererListParams list) => new RendererListHandle { Of = list };
        public IUnsafeRenderGraphBuilder AddUnsafePass<Data>(string name, out Data data) where Data : class, new() {
            data = new Data();
            return new Builder { Graph = this, Data = data };
        }
        private sealed class Builder : IUnsafeRenderGraphBuilder {
            public RenderGraph Graph;
            public object Data;
            private bool culled = true, changes, reads, draws;
            private Action<UnsafeGraphContext> run;
            public void AllowPassCulling(bool value) => culled = value;
            public void AllowGlobalStateModification(bool value) => changes = value;
            public void UseAllGlobalTextures(bool value) => reads = value;
            public void UseRendererList(in RendererListHandle list) => draws = true;
            public void SetRenderFunc<T>(BaseRenderFunc<T, UnsafeGraphContext> function) where T : class, new() =>
                run = context => function((T)Data, context);
            public void Dispose() {
                if (culled || !changes) return; // a pass without outputs
                var context = new UnsafeGraphContext();
                run(context);
                bool lit = context.cmd.Own.Rows.Exists(row => (string)row[0] == "bodies");
                if (lit && !(draws && reads)) throw new InvalidOperationException("the graph does not know what the pass reads");
                Graph.Done.Rows.AddRange(context.cmd.Own.Rows);
            }
        }
    }
}
#endif

namespace UnityEngine.Rendering.Universal {
    public enum RenderPassEvent { BeforeRendering = 0, BeforeRenderingOpaques = 250 }
    public struct CameraData {
        public Camera camera;
        public RenderTextureDescriptor cameraTargetDescriptor;
        public Matrix4x4 GetViewMatrix(int view = 0) => camera.worldToCameraMatrix;
        public Matrix4x4 GetProjectionMatrix(int view = 0) => camera.projectionMatrix;
    }
    public struct RenderingData { public CullingResults cullResults; }
#if UNITY_6000_0_OR_NEWER
    public sealed class UniversalRenderingData { public CullingResults cullResults; }
    public sealed class UniversalCameraData { }
    public sealed class UniversalLightData { }
    public static class RenderingUtils {
        public static DrawingSettings CreateDrawingSettings(
            ShaderTagId pass, UniversalRenderingData data, UniversalCameraData camera, UniversalLightData lights, SortingCriteria order) =>
            new DrawingSettings { Pass = pass };
    }
#endif
    public abstract class ScriptableRenderPass {
        public RenderPassEvent renderPassEvent { get; set; }
#if UNITY_6000_0_OR_NEWER
        public virtual void RecordRenderGraph(RenderGraphModule.RenderGraph graph, ContextContainer frame) { }
#endif
#if !UNITY_6000_0_OR_NEWER || URP_COMPATIBILITY_MODE
        public RenderTexture Target;
        public DrawingSettings CreateDrawingSettings(ShaderTagId pass, ref RenderingData data, SortingCriteria order) =>
            new DrawingSettings { Pass = pass };
#if UNITY_2022_2_OR_NEWER
        public void ConfigureTarget(RTHandle target) => Target = target.rt;
#else
        public void ConfigureTarget(RenderTargetIdentifier target) => Target = target.Texture;
#endif
#if UNITY_6000_0_OR_NEWER
        [Obsolete]
#endif
        public virtual void OnCameraSetup(CommandBuffer commands, ref RenderingData data) { }
#if UNITY_6000_0_OR_NEWER
        [Obsolete]
#endif
        public virtual void Execute(ScriptableRenderContext context, ref RenderingData data) { }
#endif
    }
    public sealed class ScriptableRenderer {
        public readonly List<ScriptableRenderPass> Passes = new List<ScriptableRenderPass>();
        public void EnqueuePass(ScriptableRenderPass pass) => Passes.Add(pass);
    }
    public abstract class ScriptableRendererFeature : ScriptableObject, IDisposable {
        public abstract void Create();
        public virtual void OnCameraPreCull(ScriptableRenderer renderer, in CameraData cameraData) { }
        public abstract void AddRenderPasses(ScriptableRenderer renderer, ref RenderingData renderingData);
        protected virtual void Dispose(bool disposing) { }
        public void Dispose() => Dispose(true);
    }
}
