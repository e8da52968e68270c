// Stand-in, written for sssgen: what SssgenScene.cs and SssgenOrbit.cs use of UnityEngine and URP. Objects keep their values.
using System;
using System.Collections.Generic;
using System.Linq;

namespace UnityEngine {
    public class Object {
        public string name = "";
        public static bool operator ==(Object a, Object b) => ReferenceEquals(a, b);
        public static bool operator !=(Object a, Object b) => !(a == b);
        public override bool Equals(object other) => ReferenceEquals(this, other);
        public override int GetHashCode() => 0;
    }
    public class MissingReferenceException : Exception { public MissingReferenceException(string message) : base(message) { } }
    public class ScriptableObject : Object { public static T CreateInstance<T>() where T : ScriptableObject, new() => new T(); }
    public class TextAsset : Object { }
    public class Texture : Object { }
    public class Shader : Object { public static Shader Find(string name) => new Shader { name = name }; }
    public class Material : Object {
        public readonly Dictionary<string, object> Values = new Dictionary<string, object>();
        public Color color { get => (Color)Values["color"]; set => Values["color"] = value; }
        public Material() { }
        public Material(Shader shader) { name = shader.name; }
        public Material(Material other) { name = other.name; }
        public void SetTexture(string property, Texture value) => Values[property] = value;
        public void SetFloat(string property, float value) => Values[property] = value;
    }

    public static class Mathf {
        public static float Clamp(float x, float low, float high) => Math.Min(Math.Max(x, low), high);
        public static float Max(float x, float y) => Math.Max(x, y);
        public static float Sin(float x) => (float)Math.Sin(x);
        public static float Cos(float x) => (float)Math.Cos(x);
    }
    public struct Vector2 { public float x, y; }
    public struct Vector3 {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 one => new Vector3(1, 1, 1);
        public static Vector3 operator +(Vector3 a, Vector3 b) => new Vector3(a.x + b.x, a.y + b.y, a.z + b.z);
        public static Vector3 operator *(Vector3 a, float b) => new Vector3(a.x * b, a.y * b, a.z * b);
        public static Vector3 operator *(float b, Vector3 a) => a * b;
        public override string ToString() => $"{x:R} {y:R} {z:R}";
    }
    public struct Color {
        public float r, g, b, a;
        public Color(float r, float g, float b, float a = 1) { this.r = r; this.g = g; this.b = b; this.a = a; }
        public float maxColorComponent => Math.Max(r, Math.Max(g, b));
        public override string ToString() => $"{r:R} {g:R} {b:R}";
    }
    public struct Bounds { public Vector3 size; }

    public class Component : Object {
        public GameObject gameObject;
        public Transform transform => gameObject.transform;
        public string tag;
    }
    public class Behaviour : Component { }
    public class MonoBehaviour : Behaviour { }
    public class Transform : Component {
        public Vector3 position, localScale = Vector3.one, Target;
        public void LookAt(Vector3 target) => Target = target;
    }
    public class GameObject : Object {
        public static readonly List<GameObject> Scene = new List<GameObject>();
        public readonly List<Component> Components = new List<Component>();
        public Transform transform { get; }
        public GameObject(string name) {
            this.name = name;
            transform = AddComponent<Transform>();
            Scene.Add(this);
        }
        public T AddComponent<T>() where T : Component, new() {
            var added = new T { gameObject = this };
            Components.Add(added);
            return added;
        }
        public T GetComponent<T>() where T : Component => Components.OfType<T>().First();
        public T[] GetComponentsInChildren<T>() where T : Component => Components.OfType<T>().ToArray();
        public static GameObject CreatePrimitive(PrimitiveType type) {
            var thing = new GameObject(type.ToString());
            thing.AddComponent<Renderer>().sharedMaterial = new Material { name = "Lit" };
            return thing;
        }
    }
    public enum PrimitiveType { Plane = 4 }
    public class Renderer : Component {
        /// <summary>The size of the mesh, as the importer has made it.</summary>
        public static Vector3 Imported;
        public Material sharedMaterial;
        public Bounds bounds => new Bounds { size = Imported };
    }
    public enum LightType { Spot = 0, Directional = 1 }
    public enum LightShadows { Soft = 2 }
    public class Light : Behaviour {
        public LightType type;
        public Color color;
        public float intensity, range, spotAngle;
        public LightShadows shadows;
    }
    public enum CameraClearFlags { SolidColor = 2 }
    public class Camera : Behaviour {
        public float fieldOfView, nearClipPlane, farClipPlane;
        public CameraClearFlags clearFlags;
        public Color backgroundColor;
        public bool allowHDR;
    }
    public static class RenderSettings {
        public static Material skybox;
        public static Rendering.AmbientMode ambientMode;
    }
    public static class DynamicGI { public static void UpdateEnvironment() { } }
    public static class Time { public static float deltaTime = 0.1f; }
    public static class Input {
        public static Vector2 mouseScrollDelta;
        public static bool GetMouseButton(int button) => true;
        public static float GetAxis(string name) => name == "Mouse X" ? 1 : 0;
    }
}

#if ENABLE_INPUT_SYSTEM
namespace UnityEngine.InputSystem {
    public class Control<T> { public T ReadValue() => default(T); }
    public class Button : Control<float> { public bool isPressed; }
    public class Mouse {
        public static Mouse current = new Mouse();
        public readonly Control<Vector2> delta = new Control<Vector2>(), scroll = new Control<Vector2>();
        public readonly Button leftButton = new Button();
    }
    public class Keyboard {
        public static Keyboard current = null;
        public readonly Button leftArrowKey = new Button(), rightArrowKey = new Button();
    }
}
#endif

namespace UnityEngine.Rendering {
    public enum AmbientMode { Skybox = 0 }
    public class RenderPipelineAsset : ScriptableObject { }
    public static class GraphicsSettings { public static RenderPipelineAsset currentRenderPipeline; }
    public class VolumeParameter<T> {
        public T value;
        public void Override(T x) => value = x;
    }
    public class VolumeComponent : ScriptableObject { }
    public class VolumeProfile : ScriptableObject { public T Add<T>(bool overrides = false) where T : VolumeComponent, new() => new T(); }
    public class Volume : MonoBehaviour {
        public bool isGlobal;
        public VolumeProfile sharedProfile;
    }
}

namespace UnityEngine.Rendering.Universal {
    public class ScriptableRendererFeature : ScriptableObject { }
    public class ScriptableRendererData : ScriptableObject {
        public List<long> m_RendererFeatureMap = new List<long>();
        public List<ScriptableRendererFeature> m_RendererFeatures = new List<ScriptableRendererFeature>();
        public List<ScriptableRendererFeature> rendererFeatures => m_RendererFeatures;
    }
    public class UniversalRendererData : ScriptableRendererData { }
    public class UniversalRenderPipelineAsset : RenderPipelineAsset {
        public List<ScriptableRendererData> m_RendererDataList = new List<ScriptableRendererData>();
    }
    public enum TonemappingMode { None, Neutral }
    public class Tonemapping : VolumeComponent { public VolumeParameter<TonemappingMode> mode = new VolumeParameter<TonemappingMode>(); }
    public class UniversalAdditionalCameraData : MonoBehaviour { public bool renderPostProcessing; }
    public static class CameraExtensions {
        public static UniversalAdditionalCameraData GetUniversalAdditionalCameraData(this Camera camera) =>
            camera.gameObject.AddComponent<UniversalAdditionalCameraData>();
    }
}

namespace Sssgen {
    public sealed class SssgenPasses : UnityEngine.Rendering.Universal.ScriptableRendererFeature { }
    public sealed class SssgenInnerLight : UnityEngine.MonoBehaviour { public UnityEngine.TextAsset bake, facts; }
}
