// The light inside a body in Unity's URP: that of all lights and of the surroundings, summed on the CPU from a bake whenever
// one of them or the body has changed. The component belongs to the body's object, and sets the values of its renderer.

// The same for all materials: a project has this file once. Made by sssgen.
namespace Sssgen {
    using System.Collections.Generic;
    using UnityEngine;
    using UnityEngine.Rendering;

    /// <summary>Gives the renderer beside it the volume of the light inside, and what the bake says of the material.</summary>
    [ExecuteAlways, RequireComponent(typeof(Renderer))]
    public sealed class SssgenInnerLight : MonoBehaviour {
        [Tooltip("The file of `sssgen bake fluence --relit`, with the ending .bytes: wax.bytes")]
        [SerializeField] private TextAsset bake;
        [Tooltip("The JSON of that file: wax.bin.json")]
        [SerializeField] private TextAsset facts;
        [Tooltip("Whether x of the mesh is negated: Unity's importers of models do so")]
        [SerializeField] private bool mirrored = true;
        [Tooltip("The material's property of the volume")]
        [SerializeField] private string property = "_InnerLight";
        [Tooltip("The seconds between two searches for lights; their values are read in each frame")]
        [SerializeField, Min(0)] private float searchInterval = 0.5f;

        private readonly List<Light> lights = new List<Light>();
        private readonly List<float> light = new List<float>();
        private readonly List<float> before = new List<float>();
        private Renderer body;
        private LightResponse response;
        private Texture3D volume;
        private ushort[] texels;
        private float nextSearch;
        private bool isStale;

        private void OnEnable() {
            isStale = true;
        }

        // the editor has changed a field; textures must not be destroyed here
        private void OnValidate() {
            isStale = true;
        }

        private void OnDisable() {
            Release();
        }

        private void Load() {
            Release();
            isStale = false;
            body = GetComponent<Renderer>();
            nextSearch = 0;
            if (bake == null || facts == null) {
                return;
            }
            response = LightResponse.Of(bake.bytes, facts.text);
            if (response == null) {
                Debug.LogWarning($"{name}: {bake.name} is no file of `sssgen bake fluence --relit`, or {facts.name} not its JSON", this);
                return;
            }
            volume = new Texture3D(response.Width, response.Height, response.Depth, TextureFormat.RGBAHalf, false) {
                filterMode = FilterMode.Bilinear, wrapMode = TextureWrapMode.Clamp, hideFlags = HideFlags.HideAndDontSave,
            };
            texels = new ushort[4 * response.Width * response.Height * response.Depth];
        }

        private void Release() {
            response = null;
            before.Clear();
            if (volume != null) {
                CoreUtils.Destroy(volume);
                volume = null;
            }
        }

        private void LateUpdate() {
            if (isStale) {
                Load();
            }
            if (response == null) {
                return;
            }
            if (Time.realtimeSinceStartup >= nextSearch) {
                nextSearch = Time.realtimeSinceStartup + searchInterval;
                lights.Clear();
                lights.AddRange(All());
            }
            Matrix4x4 mirror = Matrix4x4.Scale(new Vector3(mirrored ? -1 : 1, 1, 1));
            Matrix4x4 toWorld = body.localToWorldMatrix * mirror;
            Matrix4x4 toBake = mirror * body.worldToLocalMatrix;
            light.Clear();
            Note(toBake);
            var lamps = new List<InnerLamp>();
            foreach (Light lamp in lights) {
                if (lamp != null && lamp.isActiveAndEnabled) {
                    AddLamp(lamp, toWorld, toBake, lamps);
                }
            }
            SphericalHarmonicsL2 around = Surroundings();
            if (IsSame()) {
                return;
            }
            before.Clear();
            before.AddRange(light);
            response.Light(lamps, InnerSky.Integrals(around, toWorld), texels);
            volume.SetPixelData(texels, 0);
            volume.Apply(false);
            SetValues(toBake);
        }

        /// <summary>A light at the body, with URP's falloff; areas are left out, as in URP's own lighting.</summary>
        private void AddLamp(Light lamp, Matrix4x4 toWorld, Matrix4x4 toBake, List<InnerLamp> lamps) {
            Color shown = lamp.color.linear;
            if (lamp.useColorTemperature) {
                shown *= Mathf.CorrelatedColorTemperatureToRGB(lamp.colorTemperature);
            }
            Vector3 color = lamp.intensity * new Vector3(shown.r, shown.g, shown.b), ahead = lamp.transform.forward;
            if (lamp.type == LightType.Directional) {
                lamps.Add(new InnerLamp { Color = color, Place = toBake.MultiplyVector(-ahead) });
                Note((int)lamp.type, color, ahead);
            } else if (lamp.type == LightType.Point || lamp.type == LightType.Spot) {
                Vector3 place = lamp.transform.position;
                bool spot = lamp.type == LightType.Spot;
                float outer = spot ? Mathf.Cos(0.5f * Mathf.Deg2Rad * lamp.spotAngle) : -2;
                float inner = spot ? Mathf.Cos(0.5f * Mathf.Deg2Rad * lamp.innerSpotAngle) : -1;
                float overRange = 1 / (lamp.range * lamp.range), overRim = 1 / Mathf.Max(inner - outer, 0.001f);
                lamps.Add(new InnerLamp {
                    Color = color, Place = toBake.MultiplyPoint3x4(place),
                    Share = at => {
                        Vector3 way = toWorld.MultiplyPoint3x4(at) - place;
                        float square = Mathf.Max(way.sqrMagnitude, 1e-4f), edge = square * overRange;
                        float cosine = Vector3.Dot(way, ahead) / Mathf.Sqrt(square), rim = Mathf.Clamp01((cosine - outer) * overRim);
                        edge = Mathf.Max(1 - edge * edge, 0);
                        return edge * edge * rim * rim / square;
                    },
                });
                Note((int)lamp.type, color, place, ahead, new Vector3(overRange, outer, overRim));
            }
        }

        /// <summary>The light probes at the body, or the ambient light where there is none.</summary>
        private SphericalHarmonicsL2 Surroundings() {
            SphericalHarmonicsL2 probe = RenderSettings.ambientProbe;
            if (body.lightProbeUsage != LightProbeUsage.Off) {
                LightProbes.GetInterpolatedProbe(body.bounds.center, body, out probe);
            }
            for (int channel = 0; channel < 3; channel++) {
                for (int number = 0; number < 9; number++) {
                    light.Add(probe[channel, number]);
                }
            }
            return probe;
        }

        private void SetValues(Matrix4x4 toBake) {
            var values = new MaterialPropertyBlock();
            body.GetPropertyBlock(values);
            values.SetTexture(Shader.PropertyToID(property), volume);
            foreach (var parameter in response.Parameters) {
                int name = Shader.PropertyToID(InnerFacts.PropertyOf(parameter.Key));
                float[] numbers = parameter.Value;
                if (numbers.Length == 16) { // from the space of the bake to the volume, by columns
                    var matrix = new Matrix4x4();
                    for (int i = 0; i < 16; i++) {
                        matrix[i] = numbers[i];
                    }
                    values.SetMatrix(name, matrix * toBake);
                } else if (numbers.Length == 3) {
                    values.SetVector(name, new Vector4(numbers[0], numbers[1], numbers[2], 0));
                } else {
                    values.SetFloat(name, numbers[0]);
                }
            }
            body.SetPropertyBlock(values);
        }

        private static Light[] All() {
#if UNITY_2022_2_OR_NEWER
            return FindObjectsByType<Light>(FindObjectsSortMode.None);
#else
            return FindObjectsOfType<Light>();
#endif
        }

        // All numbers that the volume depends on.

        private void Note(Matrix4x4 matrix) {
            for (int i = 0; i < 16; i++) {
                light.Add(matrix[i]);
            }
        }

        private void Note(int kind, params Vector3[] vectors) {
            light.Add(kind);
            foreach (Vector3 vector in vectors) {
                light.Add(vector.x);
                light.Add(vector.y);
                light.Add(vector.z);
            }
        }

        private bool IsSame() {
            if (light.Count != before.Count) {
                return false;
            }
            for (int i = 0; i < light.Count; i++) {
                if (light[i] != before[i]) {
                    return false;
                }
            }
            return true;
        }
    }
}
