// Stand-in, written for sssgen: the numbers and objects of UnityEngine that SssgenPasses.cs uses, with OpenGL's clip space.
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine.Experimental.Rendering;

namespace UnityEngine.Experimental.Rendering {
    public enum GraphicsFormat { R32_SFloat = 49, R32G32B32A32_SFloat = 52 }
#if UNITY_2023_2_OR_NEWER
    public enum GraphicsFormatUsage { Linear = 2 }
#else
    public enum FormatUsage { Linear = 1 }
#endif
}

namespace UnityEngine {
    public static class SystemInfo {
#if UNITY_2023_2_OR_NEWER
        public static bool IsFormatSupported(GraphicsFormat format, GraphicsFormatUsage usage) => true;
#else
        public static bool IsFormatSupported(GraphicsFormat format, FormatUsage usage) => true;
#endif
    }

    public sealed class TooltipAttribute : Attribute { public TooltipAttribute(string text) { } }
    public sealed class SerializeField : Attribute { }
    public sealed class RangeAttribute : Attribute { public RangeAttribute(float low, float high) { } }
    public sealed class MinAttribute : Attribute { public MinAttribute(float low) { } }
    public sealed class ExecuteAlways : Attribute { }
    public sealed class RequireComponent : Attribute { public RequireComponent(Type type) { } }

    public static class Mathf {
        public const float Rad2Deg = 57.29578f, Deg2Rad = 1 / Rad2Deg, PI = 3.1415927f;
        public static float Abs(float x) => Math.Abs(x);
        public static float Asin(float x) => (float)Math.Asin(x);
        public static float Max(float x, float y) => Math.Max(x, y);
        public static float Min(float x, float y) => Math.Min(x, y);
        public static int Min(int x, int y) => Math.Min(x, y);
        public static float Pow(float x, float y) => (float)Math.Pow(x, y);
        public static float Sqrt(float x) => (float)Math.Sqrt(x);
        public static float Sin(float x) => (float)Math.Sin(x);
        public static float Cos(float x) => (float)Math.Cos(x);
        public static float Clamp(float x, float low, float high) => Math.Min(Math.Max(x, low), high);
        public static int Clamp(int x, int low, int high) => Math.Min(Math.Max(x, low), high);
        public static float Clamp01(float x) => Clamp(x, 0, 1);
        public static Color CorrelatedColorTemperatureToRGB(float kelvin) => new Color(1, 0.5f, 0.25f);
        public static int FloorToInt(float x) => (int)Math.Floor(x);
        public static int RoundToInt(float x) => (int)Math.Round(x);
        public static float HalfToFloat(ushort half) {
            int exponent = half >> 10 & 31, fraction = half & 1023;
            double size = exponent == 0 ? fraction * Math.Pow(2, -24) : (1 + fraction / 1024.0) * Math.Pow(2, exponent - 15);
            return (float)((half & 32768) != 0 ? -size : size);
        }
        public static ushort FloatToHalf(float x) { // not negative
            int bits = BitConverter.ToInt32(BitConverter.GetBytes(x), 0);
            return (ushort)(bits < 0x38800000 ? (int)Math.Round(x * Math.Pow(2, 24)) : bits - 0x38000000 + 0x1000 >> 13);
        }
    }

    public struct Vector2Int {
        public int x, y;
        public Vector2Int(int x, int y) { this.x = x; this.y = y; }
    }

    public struct Vector3 {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 zero => new Vector3();
        public static Vector3 right => new Vector3(1, 0, 0);
        public static Vector3 up => new Vector3(0, 1, 0);
        public static Vector3 forward => new Vector3(0, 0, 1);
        public float sqrMagnitude => Dot(this, this);
        public float magnitude => (float)Math.Sqrt(sqrMagnitude);
        public Vector3 normalized => this * (1 / magnitude);
        public static float Dot(Vector3 a, Vector3 b) => a.x * b.x + a.y * b.y + a.z * b.z;
        public static Vector3 Cross(Vector3 a, Vector3 b) =>
            new Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
        public static Vector3 Scale(Vector3 a, Vector3 b) => new Vector3(a.x * b.x, a.y * b.y, a.z * b.z);
        public static float Angle(Vector3 a, Vector3 b) =>
            Mathf.Rad2Deg * (float)Math.Acos(Dot(a.normalized, b.normalized));
        public static Vector3 operator +(Vector3 a, Vector3 b) => new Vector3(a.x + b.x, a.y + b.y, a.z + b.z);
        public static Vector3 operator -(Vector3 a, Vector3 b) => a + -b;
        public static Vector3 operator -(Vector3 a) => a * -1;
        public static Vector3 operator *(Vector3 a, float b) => new Vector3(a.x * b, a.y * b, a.z * b);
        public static Vector3 operator *(float b, Vector3 a) => a * b;
    }

    public struct Vector4 {
        public float x, y, z, w;
        public Vector4(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
        public static implicit operator Vector4(Vector3 v) => new Vector4(v.x, v.y, v.z, 0);
        public static Vector4 operator +(Vector4 a, Vector4 b) => new Vector4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w);
        public static Vector4 operator -(Vector4 a) => -1 * a;
        public static Vector4 operator *(float b, Vector4 a) => new Vector4(a.x * b, a.y * b, a.z * b, a.w * b);
        public static Vector4 operator /(Vector4 a, float b) => 1 / b * a;
    }

    public struct Matrix4x4 {
        private Vector4 row0, row1, row2, row3;
        public static Matrix4x4 zero => new Matrix4x4();
        public static Matrix4x4 identity => Of(1, 1, 1, 1);
        public static Matrix4x4 Scale(Vector3 scale) => Of(scale.x, scale.y, scale.z, 1);
        /// <summary>By columns.</summary>
        public float this[int index] {
            get { Vector4 row = GetRow(index % 4); return new[] { row.x, row.y, row.z, row.w }[index / 4]; }
            set {
                Vector4 row = GetRow(index % 4);
                var parts = new[] { row.x, row.y, row.z, row.w };
                parts[index / 4] = value;
                SetRow(index % 4, new Vector4(parts[0], parts[1], parts[2], parts[3]));
            }
        }
        public Vector3 MultiplyVector(Vector3 way) => MultiplyPoint3x4(way) - MultiplyPoint3x4(Vector3.zero);
        public Vector3 MultiplyPoint3x4(Vector3 place) => new Vector3(Behind(row0, place), Behind(row1, place), Behind(row2, place));
        private static float Behind(Vector4 row, Vector3 place) => row.x * place.x + row.y * place.y + row.z * place.z + row.w;
        public Vector4 GetRow(int row) => row == 0 ? row0 : row == 1 ? row1 : row == 2 ? row2 : row3;
        public void SetRow(int row, Vector4 value) {
            if (row == 0) row0 = value;
            if (row == 1) row1 = value;
            if (row == 2) row2 = value;
            if (row == 3) row3 = value;
        }
        private static Matrix4x4 Of(float x, float y, float z, float w) => new Matrix4x4 {
            row0 = new Vector4(x, 0, 0, 0), row1 = new Vector4(0, y, 0, 0), row2 = new Vector4(0, 0, z, 0), row3 = new Vector4(0, 0, 0, w),
        };
        public static Matrix4x4 Ortho(float left, float right, float bottom, float top, float near, float far) {
            var result = Of(2 / (right - left), 2 / (top - bottom), -2 / (far - near), 1);
            result.row0.w = -(right + left) / (right - left);
            result.row1.w = -(top + bottom) / (top - bottom);
            result.row2.w = -(far + near) / (far - near);
            return result;
        }
        public static Matrix4x4 Frustum(float left, float right, float bottom, float top, float near, float far) {
            var result = Of(2 * near / (right - left), 2 * near / (top - bottom), -(far + near) / (far - near), 0);
            result.row0.z = (right + left) / (right - left);
            result.row1.z = (top + bottom) / (top - bottom);
            result.row2.w = -2 * far * near / (far - near);
            result.row3.z = -1;
            return result;
        }
        public static Matrix4x4 operator *(Matrix4x4 a, Matrix4x4 b) {
            var result = new Matrix4x4();
            for (int i = 0; i < 4; i++) {
                Vector4 row = a.GetRow(i);
                result.SetRow(i, row.x * b.row0 + row.y * b.row1 + row.z * b.row2 + row.w * b.row3);
            }
            return result;
        }
    }

    public struct Rect {
        public float x, y, width, height;
        public Rect(float x, float y, float width, float height) { this.x = x; this.y = y; this.width = width; this.height = height; }
    }

    public struct Bounds {
        public Vector3 center, extents;
        public Bounds(Vector3 center, Vector3 size) { this.center = center; extents = size * 0.5f; }
    }

    public struct Color {
        public float r, g, b, a;
        public Color(float r, float g, float b, float a = 1) { this.r = r; this.g = g; this.b = b; this.a = a; }
        public Color linear => this; // the scene has linear colours
        public float maxColorComponent => Math.Max(r, Math.Max(g, b));
        public static Color operator *(Color a, Color b) => new Color(a.r * b.r, a.g * b.g, a.b * b.b, a.a * b.a);
    }

    public struct Plane { }

    public static class Debug {
        public static readonly List<string> Warnings = new List<string>();
        public static void LogWarning(object message, Object context) => Warnings.Add(message.ToString());
    }

    [Flags] public enum HideFlags { HideAndDontSave = 61 }
    public class Object {
        public HideFlags hideFlags;
        public static readonly List<Object> Scene = new List<Object>();
        public string name = "";
#if UNITY_2022_2_OR_NEWER
        public static T[] FindObjectsByType<T>(FindObjectsSortMode order) where T : Object => Scene.OfType<T>().ToArray();
#else
        public static T[] FindObjectsOfType<T>() where T : Object => Scene.OfType<T>().ToArray();
#endif
    }
#if UNITY_2022_2_OR_NEWER
    public enum FindObjectsSortMode { None }
#endif

    public class ScriptableObject : Object { }
    public class Transform : Object { public Vector3 position, forward; }
    public class GameObject : Object { public bool activeInHierarchy = true; public int layer; }
    public class Component : Object {
        public readonly GameObject gameObject = new GameObject();
        public readonly Transform transform = new Transform();
    }
    public class Behaviour : Component { public bool isActiveAndEnabled = true; }
    public class MonoBehaviour : Behaviour { public T GetComponent<T>() where T : Component => Scene.OfType<T>().First(); }
    public sealed class TextAsset : Object { public byte[] bytes; public string text; }
    public static class RenderSettings { public static Rendering.SphericalHarmonicsL2 ambientProbe; }
    public static class LightProbes {
        public static void GetInterpolatedProbe(Vector3 place, Renderer body, out Rendering.SphericalHarmonicsL2 probe) =>
            probe = RenderSettings.ambientProbe;
    }

    public enum LightType { Spot, Directional, Point, Rectangle }
    public sealed class Light : Behaviour {
        public LightType type;
        public Color color;
        public float intensity = 1, range = 1e4f, spotAngle = 30, innerSpotAngle = 20, colorTemperature = 6570;
        public bool useColorTemperature;
    }

    public enum CameraType { Game = 1, Preview = 4 }
    public sealed class Camera : Behaviour {
        public CameraType cameraType = CameraType.Game;
        public int cullingMask = -1;
        public Matrix4x4 worldToCameraMatrix, projectionMatrix;
    }
    public static class GeometryUtility {
        public static Plane[] CalculateFrustumPlanes(Camera camera) => new Plane[6];
        public static bool TestPlanesAABB(Plane[] planes, Bounds box) => true;
    }
    public static class GL {
        public static Matrix4x4 GetGPUProjectionMatrix(Matrix4x4 projection, bool intoTexture) => projection;
    }
    public static class Time { public static float realtimeSinceStartup; }

    public class Texture : Object { public int width, height; public FilterMode filterMode; public TextureWrapMode wrapMode; }
    public enum FilterMode { Point, Bilinear }
    public enum TextureWrapMode { Repeat, Clamp }
    public enum TextureFormat { RGBAHalf = 17 }
    public sealed class Texture3D : Texture {
        public ushort[] Texels;
        public int Applied;
        public Texture3D(int width, int height, int depth, TextureFormat format, bool mipmaps) { this.width = width; this.height = height; }
        public void SetPixelData<T>(T[] data, int level) => Texels = (ushort[])(object)data.Clone();
        public void Apply(bool mipmaps) => Applied++;
    }
    public enum RenderTextureFormat { ARGBFloat = 11, RFloat = 14 }
    public enum RenderTextureReadWrite { Linear = 1 }
    public struct RenderTextureDescriptor { public int width, height; }
    public sealed class RenderTexture : Texture {
        public static readonly HashSet<RenderTexture> Lent = new HashSet<RenderTexture>();
        public readonly int Number;
        public RenderTextureFormat format;
        public GraphicsFormat graphicsFormat => format == RenderTextureFormat.RFloat ? GraphicsFormat.R32_SFloat : GraphicsFormat.R32G32B32A32_SFloat;
        private static int count;
        public RenderTexture(int width, int height, int depth) { this.width = width; this.height = height; Number = count++; }
        public static RenderTexture GetTemporary(int width, int height, int depth, RenderTextureFormat format, RenderTextureReadWrite space) {
            var texture = new RenderTexture(width, height, depth) { format = format };
            Lent.Add(texture);
            return texture;
        }
        public static void ReleaseTemporary(RenderTexture texture) {
            if (!Lent.Remove(texture)) throw new InvalidOperationException("released twice");
        }
    }

    public sealed class Shader : Object {
        private static readonly List<string> Names = new List<string>();
        public Dictionary<string, string> Tags = new Dictionary<string, string>();
        /// <summary>For each pass its tags.</summary>
        public List<Dictionary<string, string>> Passes = new List<Dictionary<string, string>>();
        public int passCount => Passes.Count;
        public Rendering.ShaderTagId FindPassTagValue(int pass, Rendering.ShaderTagId tag) =>
            new Rendering.ShaderTagId(Passes[pass].TryGetValue(tag.name, out string value) ? value : "");
        public static int PropertyToID(string name) {
            if (!Names.Contains(name)) Names.Add(name);
            return Names.IndexOf(name);
        }
        public static string NameOf(int property) => Names[property];
    }
    public sealed class Material : Object {
        public Shader shader;
        public readonly Dictionary<int, Texture> Textures = new Dictionary<int, Texture>();
        public Texture GetTexture(int name) => Textures.TryGetValue(name, out Texture texture) ? texture : null;
        public string GetTag(string tag, bool searchFallbacks, string defaultValue) =>
            shader.Tags.TryGetValue(tag, out string value) ? value : defaultValue;
    }
    public sealed class MaterialPropertyBlock {
        public readonly Dictionary<int, object> Values = new Dictionary<int, object>();
        public Texture GetTexture(int name) => Values.TryGetValue(name, out object texture) ? (Texture)texture : null;
        public void SetMatrix(int name, Matrix4x4 value) => Values[name] = value;
        public void SetVector(int name, Vector4 value) => Values[name] = value;
        public void SetFloat(int name, float value) => Values[name] = value;
        public void SetTexture(int name, Texture value) => Values[name] = value;
    }
    public sealed class Renderer : Component {
        public bool enabled = true;
        public Bounds bounds;
        public Matrix4x4 localToWorldMatrix, worldToLocalMatrix;
        public Rendering.LightProbeUsage lightProbeUsage = Rendering.LightProbeUsage.BlendProbes;
        public Material[] Materials;
        public readonly Dictionary<int, object> Values = new Dictionary<int, object>();
        public void GetSharedMaterials(List<Material> materials) { materials.Clear(); materials.AddRange(Materials); }
        public void GetPropertyBlock(MaterialPropertyBlock block) {
            block.Values.Clear();
            foreach (var value in Values) block.Values.Add(value.Key, value.Value);
        }
        public void SetPropertyBlock(MaterialPropertyBlock block) {
            Values.Clear();
            foreach (var value in block.Values) Values.Add(value.Key, value.Value);
        }
    }
}
