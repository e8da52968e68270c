// What is drawn into the pictures: the distances of a body's faces, and the light on it.
namespace Sssgen {
    using System.Collections.Generic;
    using UnityEngine;
    using UnityEngine.Rendering;

    /// <summary>Draws distances of bodies, layer by layer.</summary>
    public sealed class DistanceDrawing : Drawing {
        private static readonly int Gap = Shader.PropertyToID("_SssgenGap");
        private static readonly int Before = Shader.PropertyToID("_SssgenBefore");
        private readonly List<(RenderTexture texture, List<Shown> bodies)> pictures = new List<(RenderTexture, List<Shown>)>();
        private readonly Dictionary<string, int> shared = new Dictionary<string, int>();

        public override bool HasPictures => pictures.Count > 0;

        public override RenderTexture Add(Shown body, Vector2Int size) {
            // the eye sees all bodies in one picture: where bodies are beside each other, the nearest back face is that of
            // the visible one, but what is behind it may be another body's
            bool together = body.Picture.ByEye && body.Picture.Layers.Count == 1;
            if (together && shared.TryGetValue(body.Picture.Name, out int place)) {
                pictures[place].bodies.Add(body);
                return pictures[place].texture;
            }
            bool several = body.Picture.Layers.Count > 1;
            RenderTextureFormat format = several ? RenderTextureFormat.ARGBFloat : RenderTextureFormat.RFloat;
            RenderTexture texture = Texture(size, format, 32, !body.Picture.ByEye);
            if (together) {
                shared[body.Picture.Name] = pictures.Count;
            }
            pictures.Add((texture, new List<Shown> { body }));
            return texture;
        }

        public override void Clear() {
            base.Clear();
            pictures.Clear();
            shared.Clear();
        }

        protected override void Draw(CommandBuffer commands) {
            RenderTexture before = null;
            foreach (var drawn in pictures) {
                RenderTexture texture = drawn.texture;
                ShaderPicture picture = drawn.bodies[0].Picture;
                float end = 0;
                if (picture.EmptyIsFar) {
                    drawn.bodies[0].Views.ForEach(view => end = Mathf.Max(end, view.End));
                }
                var empty = new Color(end, end, end, end);
                if (picture.Behind.Contains(true) && (before == null || before.width != texture.width)) {
                    before = Texture(new Vector2Int(texture.width, texture.height), texture.format, 0, false);
                }
                for (int layer = 0; layer < picture.Layers.Count; layer++) {
                    if (picture.Behind[layer]) {
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
                commands.SetViewport(new Rect(i % columns * width, i / columns * height, width, height));
                See(commands, body.Views[i]);
                for (int part = 0; part < body.Parts; part++) {
                    commands.DrawRenderer(body.Renderer, body.Material, part, body.Picture.Layers[layer]);
                }
            }
        }
    }

    /// <summary>Draws what all bodies of a camera reflect as white matt ones. URP draws them, as it gives each its lights.</summary>
    public sealed class LightDrawing : Drawing {
        private RenderTexture picture;
        private View eye;

        public override bool HasPictures => picture != null;

        protected override string LitBodies => ShaderPicture.Light;

        public override RenderTexture Add(Shown body, Vector2Int size) {
            if (picture == null) {
                picture = Texture(size, RenderTextureFormat.ARGBFloat, 32, true);
                eye = body.Views[0];
            }
            return picture;
        }

        public override void Clear() {
            base.Clear();
            picture = null;
        }

        protected override void Draw(CommandBuffer commands) {
            commands.SetRenderTarget(picture);
            commands.ClearRenderTarget(true, true, new Color(0, 0, 0, eye.End));
            See(commands, eye);
        }
    }
}
