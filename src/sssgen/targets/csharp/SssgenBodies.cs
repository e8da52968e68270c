// The bodies with the pictures and textures that their materials need. The tags of a shader say what it needs.
namespace Sssgen {
    using System.Collections.Generic;
    using UnityEngine;
    using UnityEngine.Rendering;

    /// <summary>A picture that a shader needs. Its passes draw it, and their tags describe it.</summary>
    public sealed class ShaderPicture {
        /// <summary>The LightMode of a pass that shows the light on a body; others show distances.</summary>
        public const string Light = "SssgenLight";

        public readonly string Name;
        public readonly string SeenFrom;
        public readonly int Texture;
        /// <summary>The properties of the matrices from world space to the picture, one for each light.</summary>
        public readonly int[] Views;
        /// <summary>Whether a texel without a surface has the end of the view; else 0.</summary>
        public readonly bool EmptyIsFar;
        public readonly bool ShowsLight;
        /// <summary>The numbers of the passes: of distances one for each layer.</summary>
        public readonly List<int> Layers = new List<int>();
        /// <summary>For each layer whether its surfaces are behind those of the layer before.</summary>
        public readonly List<bool> Behind = new List<bool>();

        private ShaderPicture(string name, Shader shader, int pass) {
            Name = name;
            SeenFrom = Tag(shader, pass, "SssgenSeenFrom");
            Texture = Shader.PropertyToID(Tag(shader, pass, "SssgenTexture"));
            string views = Tag(shader, pass, "SssgenViews");
            Views = views == "" ? new int[0] : System.Array.ConvertAll(views.Split(' '), Shader.PropertyToID);
            EmptyIsFar = Tag(shader, pass, "SssgenEmpty") == "far";
            ShowsLight = Tag(shader, pass, "LightMode") == Light;
        }

        public bool ByEye => SeenFrom == "eye";

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
                picture.Behind.Add(Tag(shader, pass, "SssgenBehind") != "");
            }
            return found;
        }

        private static string Tag(Shader shader, int pass, string name) {
            return shader.FindPassTagValue(pass, new ShaderTagId(name)).name ?? "";
        }
    }

    /// <summary>What the materials of a shader need.</summary>
    public sealed class ShaderNeeds {
        public readonly List<ShaderPicture> Pictures;
        /// <summary>Of each texture that the user gives its property, and how it is made.</summary>
        public readonly List<(string property, string how)> Textures = new List<(string, string)>();

        public ShaderNeeds(Material material) {
            Pictures = ShaderPicture.Of(material.shader);
            string needed = material.GetTag("SssgenNeeds", false, "");
            foreach (string property in needed.Split(new[] { ' ' }, System.StringSplitOptions.RemoveEmptyEntries)) {
                Textures.Add((property, material.GetTag("SssgenNeeds" + property, false, "")));
            }
        }
    }

    /// <summary>A renderer with what its materials need.</summary>
    public sealed class Body {
        private static readonly List<Material> Materials = new List<Material>();
        private readonly Renderer renderer;
        private readonly List<(ShaderPicture picture, Material material)> pictures = new List<(ShaderPicture, Material)>();
        private readonly List<(Material material, ShaderNeeds own)> needs = new List<(Material, ShaderNeeds)>();
        private readonly MaterialPropertyBlock values = new MaterialPropertyBlock();
        private readonly int parts;

        /// <param name="known">The needs of the shaders that were seen before.</param>
        public Body(Renderer renderer, Dictionary<Shader, ShaderNeeds> known) {
            this.renderer = renderer;
            renderer.GetSharedMaterials(Materials);
            parts = Materials.Count;
            foreach (Material material in Materials) {
                if (material == null) {
                    continue;
                }
                if (!known.TryGetValue(material.shader, out ShaderNeeds own)) {
                    known[material.shader] = own = new ShaderNeeds(material);
                }
                needs.Add((material, own));
                foreach (ShaderPicture picture in own.Pictures) {
                    if (!pictures.Exists(other => other.picture.Texture == picture.Texture)) {
                        pictures.Add((picture, material));
                    }
                }
            }
        }

        public bool HasPictures => pictures.Count > 0;

        public bool IsSeen(Camera camera, Plane[] sides) {
            return renderer != null && renderer.enabled && renderer.gameObject.activeInHierarchy
                && (camera.cullingMask & (1 << renderer.gameObject.layer)) != 0
                && GeometryUtility.TestPlanesAABB(sides, renderer.bounds);
        }

        /// <summary>Warns of the textures that its materials lack, of each material once.</summary>
        public void WarnOfMissing(HashSet<Material> warned) {
            foreach (var need in needs) {
                Material material = need.material;
                if (need.own.Textures.Count == 0 || warned.Contains(material)) {
                    continue;
                }
                renderer.GetPropertyBlock(values);
                var missing = need.own.Textures.FindAll(texture => IsMissing(material, texture.property));
                foreach (var texture in missing) {
                    warned.Add(material);
                    Debug.LogWarning($"{material.name}: {texture.property} is missing: {texture.how}", material);
                }
            }
        }

        private bool IsMissing(Material material, string property) {
            int name = Shader.PropertyToID(property);
            return material.GetTexture(name) == null && values.GetTexture(name) == null;
        }

        /// <summary>Adds what is drawn for a camera, and sets the pictures and their views.</summary>
        public void AddPictures(
            DistanceDrawing distances, LightDrawing reflections, View eye, Vector2Int size, List<Light> lights, int side) {
            renderer.GetPropertyBlock(values);
            foreach (var need in pictures) {
                ShaderPicture picture = need.picture;
                Material material = need.material;
                if (material == null || material.GetTexture(picture.Texture) != null) {
                    continue;
                }
                var views = new List<View>();
                if (picture.ByEye) {
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
                Drawing drawing = picture.ShowsLight ? (Drawing)reflections : distances;
                values.SetTexture(picture.Texture, drawing.Add(shown, picture.ByEye ? size : new Vector2Int(side, side)));
            }
            renderer.SetPropertyBlock(values);
        }
    }
}
