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
        private void Add(params object[] row) => Rows.Add(row);
    }

    public sealed class ScriptableRenderContext {
        public readonly List<CommandBuffer> Done = new List<CommandBuffer>();
        public void ExecuteCommandBuffer(CommandBuffer commands) => Done.Add(commands);
    }

    public static class CommandBufferPool {
        public static CommandBuffer Get(string name) => new CommandBuffer();
        public static void Release(CommandBuffer commands) { }
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
    public sealed class ContextContainer { }
    public sealed class UnsafeCommandBuffer { public readonly CommandBuffer Own = new CommandBuffer(); }
    public static class CommandBufferHelpers {
        public static CommandBuffer GetNativeCommandBuffer(UnsafeCommandBuffer commands) => commands.Own;
    }
#endif
}

#if UNITY_6000_0_OR_NEWER
namespace UnityEngine.Rendering.RenderGraphModule {
    public delegate void BaseRenderFunc<Data, Context>(Data data, Context context) where Data : class, new();
    public sealed class UnsafeGraphContext { public UnsafeCommandBuffer cmd = new UnsafeCommandBuffer(); }
    public interface IUnsafeRenderGraphBuilder : IDisposable {
        void AllowPassCulling(bool value);
        void AllowGlobalStateModification(bool value);
        void SetRenderFunc<Data>(BaseRenderFunc<Data, UnsafeGraphContext> function) where Data : class, new();
    }
    public sealed class RenderGraph {
        public readonly List<CommandBuffer> Done = new List<CommandBuffer>();
        public IUnsafeRenderGraphBuilder AddUnsafePass<Data>(string name, out Data data) where Data : class, new() {
            data = new Data();
            return new Builder { Graph = this, Data = data };
        }
        private sealed class Builder : IUnsafeRenderGraphBuilder {
            public RenderGraph Graph;
            public object Data;
            private bool culled = true, changes;
            private Action<UnsafeGraphContext> run;
            public void AllowPassCulling(bool value) => culled = value;
            public void AllowGlobalStateModification(bool value) => changes = value;
            public void SetRenderFunc<T>(BaseRenderFunc<T, UnsafeGraphContext> function) where T : class, new() =>
                run = context => function((T)Data, context);
            public void Dispose() {
                if (culled || !changes) return; // a pass without outputs
                var context = new UnsafeGraphContext();
                run(context);
                Graph.Done.Add(context.cmd.Own);
            }
        }
    }
}
#endif

namespace UnityEngine.Rendering.Universal {
    public enum RenderPassEvent { BeforeRendering = 0 }
    public struct CameraData {
        public Camera camera;
        public RenderTextureDescriptor cameraTargetDescriptor;
        public Matrix4x4 GetViewMatrix(int view = 0) => camera.worldToCameraMatrix;
        public Matrix4x4 GetProjectionMatrix(int view = 0) => camera.projectionMatrix;
    }
    public struct RenderingData { }
    public abstract class ScriptableRenderPass {
        public RenderPassEvent renderPassEvent { get; set; }
#if UNITY_6000_0_OR_NEWER
        public virtual void RecordRenderGraph(RenderGraphModule.RenderGraph graph, ContextContainer frame) { }
#endif
#if !UNITY_6000_0_OR_NEWER || URP_COMPATIBILITY_MODE
        public RenderTexture Target;
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
