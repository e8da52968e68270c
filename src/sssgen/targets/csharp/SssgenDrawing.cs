// How URP draws a picture, in each of its versions.
namespace Sssgen {
    using System.Collections.Generic;
    using UnityEngine;
    using UnityEngine.Experimental.Rendering;
    using UnityEngine.Rendering;
    using UnityEngine.Rendering.Universal;
#if UNITY_6000_0_OR_NEWER
    using UnityEngine.Rendering.RenderGraphModule;
#endif

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

    /// <summary>Draws pictures of a camera. They are kept until the next camera is drawn.</summary>
    public abstract class Drawing : ScriptableRenderPass {
#if UNITY_2023_2_OR_NEWER
        private const GraphicsFormatUsage Filtered = GraphicsFormatUsage.Linear;
#else
        private const FormatUsage Filtered = FormatUsage.Linear;
#endif
        private static readonly int Clip = Shader.PropertyToID("_SssgenClip");
        private static readonly int Eye = Shader.PropertyToID("_SssgenEye");
        private static readonly int Plane = Shader.PropertyToID("_SssgenPlane");
        private readonly List<RenderTexture> lent = new List<RenderTexture>();

        public abstract bool HasPictures { get; }

        /// <summary>The texture in which a body will be shown.</summary>
        public abstract RenderTexture Add(Shown body, Vector2Int size);

        public virtual void Clear() {
            lent.ForEach(RenderTexture.ReleaseTemporary);
            lent.Clear();
        }

        protected abstract void Draw(CommandBuffer commands);

        /// <summary>The LightMode of the passes with which URP draws all bodies that it sees, after Draw; null: none.</summary>
        protected virtual string LitBodies => null;

        protected RenderTexture Texture(Vector2Int size, RenderTextureFormat format, int depth, bool filtered) {
            RenderTexture texture = RenderTexture.GetTemporary(size.x, size.y, depth, format, RenderTextureReadWrite.Linear);
            filtered = filtered && SystemInfo.IsFormatSupported(texture.graphicsFormat, Filtered);
            texture.filterMode = filtered ? FilterMode.Bilinear : FilterMode.Point;
            texture.wrapMode = TextureWrapMode.Clamp;
            lent.Add(texture);
            return texture;
        }

        /// <summary>Sets the view of what is drawn next.</summary>
        protected static void See(CommandBuffer commands, View view) {
            commands.SetGlobalMatrix(Clip, GL.GetGPUProjectionMatrix(view.Projection, true) * view.Camera);
            commands.SetGlobalVector(Eye, view.Eye);
            commands.SetGlobalVector(Plane, view.Plane);
        }

#if UNITY_6000_0_OR_NEWER
        private sealed class Data {
            public Drawing Drawing;
            public RendererListHandle Lit;
        }

        public override void RecordRenderGraph(RenderGraph graph, ContextContainer frame) {
            using (IUnsafeRenderGraphBuilder builder = graph.AddUnsafePass("sssgen", out Data data)) {
                data.Drawing = this;
                if (LitBodies != null) {
                    var all = frame.Get<UniversalRenderingData>();
                    DrawingSettings settings = RenderingUtils.CreateDrawingSettings(
                        new ShaderTagId(LitBodies), all, frame.Get<UniversalCameraData>(), frame.Get<UniversalLightData>(),
                        SortingCriteria.CommonOpaque);
                    var filter = new FilteringSettings(RenderQueueRange.all);
                    data.Lit = graph.CreateRendererList(new RendererListParams(all.cullResults, settings, filter));
                    builder.UseRendererList(data.Lit);
                    builder.UseAllGlobalTextures(true); // the shadow maps
                }
                builder.AllowPassCulling(false); // the graph does not know who reads the pictures
                builder.AllowGlobalStateModification(true);
                builder.SetRenderFunc((Data own, UnsafeGraphContext context) => {
                    CommandBuffer commands = CommandBufferHelpers.GetNativeCommandBuffer(context.cmd);
                    own.Drawing.Draw(commands);
                    if (own.Drawing.LitBodies != null) {
                        commands.DrawRendererList(own.Lit);
                    }
                });
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
            if (LitBodies != null) {
                var pass = new ShaderTagId(LitBodies);
                DrawingSettings settings = CreateDrawingSettings(pass, ref data, SortingCriteria.CommonOpaque);
                var filter = new FilteringSettings(RenderQueueRange.all);
#if UNITY_6000_0_OR_NEWER
                var lit = new RendererListParams(data.cullResults, settings, filter);
                commands.DrawRendererList(context.CreateRendererList(ref lit));
#else
                context.ExecuteCommandBuffer(commands);
                commands.Clear();
                context.DrawRenderers(data.cullResults, ref settings, ref filter);
#endif
            }
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
