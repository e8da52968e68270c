// Stand-in, written for sssgen: what SssgenScene.cs uses of UnityEditor, on a folder with .meta files; and the program, which
// chooses the menus of that folder twice and writes the scene as rows.
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.Rendering.Universal;

namespace UnityEditor {
    public sealed class MenuItem : Attribute {
        public readonly string Path;
        public MenuItem(string path) { Path = path; }
    }
    public static class EditorUtility {
        public static bool DisplayDialog(string title, string message, string ok) {
            Console.WriteLine("dialog\t" + message);
            return true;
        }
        public static void SetDirty(UnityEngine.Object thing) { }
    }
    public static class AssetDatabase {
        public static readonly Dictionary<string, string> Paths = new Dictionary<string, string>();
        public static readonly List<string> Added = new List<string>();
        public static string GUIDToAssetPath(string guid) => Paths.TryGetValue(guid, out string path) ? path : "";
        public static T LoadAssetAtPath<T>(string path) where T : UnityEngine.Object {
            if (path.Length == 0) return null;
            object made = typeof(T) == typeof(GameObject) ? new GameObject("model") : Activator.CreateInstance(typeof(T));
            ((UnityEngine.Object)made).name = path;
            return (T)made;
        }
        public static void AddObjectToAsset(UnityEngine.Object thing, UnityEngine.Object asset) => Added.Add(thing.name);
        public static void SaveAssets() { }
        public static bool TryGetGUIDAndLocalFileIdentifier(UnityEngine.Object thing, out string guid, out long number) {
            guid = "";
            number = 11;
            return true;
        }
    }
    public static class PrefabUtility {
        public static UnityEngine.Object InstantiatePrefab(UnityEngine.Object model) {
            ((GameObject)model).AddComponent<Renderer>();
            return model;
        }
    }
    public static class Selection { public static GameObject activeGameObject; }
    public sealed class SceneView {
        public static SceneView lastActiveSceneView;
        public void AlignViewToObject(Transform thing) { }
    }
    /// <summary>A field of an object, by its name, or an element of a list.</summary>
    public sealed class SerializedProperty {
        public Func<object> Get;
        public Action<object> Set;
        private IList List => (IList)Get();
        public int arraySize {
            get => List.Count;
            set { while (List.Count < value) List.Add(Default(List)); }
        }
        public SerializedProperty GetArrayElementAtIndex(int index) =>
            new SerializedProperty { Get = () => List[index], Set = value => List[index] = value };
        public UnityEngine.Object objectReferenceValue { get => (UnityEngine.Object)Get(); set => Set(value); }
        public long longValue { get => (long)Get(); set => Set(value); }
        private static object Default(IList list) => list is List<long> ? (object)0L : null;
    }
    public sealed class SerializedObject {
        private readonly object thing;
        public SerializedObject(UnityEngine.Object thing) { this.thing = thing; }
        public SerializedProperty FindProperty(string name) {
            FieldInfo field = thing.GetType().GetField(name);
            return new SerializedProperty { Get = () => field.GetValue(thing), Set = value => field.SetValue(thing, value) };
        }
        public bool ApplyModifiedProperties() => true;
    }
}

namespace UnityEditor.SceneManagement {
    public enum NewSceneSetup { EmptyScene }
    public enum NewSceneMode { Single }
    public static class EditorSceneManager {
        public static bool SaveCurrentModifiedScenesIfUserWantsTo() => true;
        public static void NewScene(NewSceneSetup setup, NewSceneMode mode) => GameObject.Scene.Clear();
    }
}

public static class Program {
    public static void Main(string[] arguments) {
        CultureInfo.DefaultThreadCurrentCulture = CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        foreach (string meta in Directory.GetFiles(arguments[0], "*.meta", SearchOption.AllDirectories)) {
            string guid = File.ReadLines(meta).First(line => line.StartsWith("guid: ")).Substring(6);
            UnityEditor.AssetDatabase.Paths.Add(guid, meta.Substring(0, meta.Length - 5));
        }
        Renderer.Imported = new Vector3(0.01f, 0.02f, 0.005f);
        var menus = typeof(Program).Assembly.GetTypes().SelectMany(type => type.GetMethods(BindingFlags.Static | BindingFlags.NonPublic))
            .Where(method => method.GetCustomAttribute<UnityEditor.MenuItem>() != null).ToList();
        Choose(menus);
        var data = new UniversalRendererData();
        GraphicsSettings.currentRenderPipeline = new UniversalRenderPipelineAsset { m_RendererDataList = { data } };
        Choose(menus);
        Choose(menus);
        Console.WriteLine($"features\t{string.Join(" ", data.m_RendererFeatures.Select(feature => feature.name))}\t{string.Join(" ", data.m_RendererFeatureMap)}");
        foreach (GameObject thing in GameObject.Scene.Where(thing => thing.Components.Count > 1)) Write(thing);
        Console.WriteLine($"sky\t{((UnityEngine.Object)RenderSettings.skybox.Values["_MainTex"]).name}\t{RenderSettings.skybox.Values["_Exposure"]}");
        var orbit = GameObject.Scene.SelectMany(thing => thing.Components).OfType<Sssgen.SssgenOrbit>().First();
        typeof(Sssgen.SssgenOrbit).GetMethod("LateUpdate", BindingFlags.Instance | BindingFlags.NonPublic).Invoke(orbit, null);
        Console.WriteLine($"dragged\t{orbit.transform.position}");
    }

    private static void Choose(List<MethodInfo> menus) {
        foreach (MethodInfo menu in menus) menu.Invoke(null, null);
    }

    private static void Write(GameObject thing) {
        string material = string.Join(" ", thing.Components.OfType<Renderer>().Select(renderer => renderer.sharedMaterial.name));
        string light = string.Join(" ", thing.Components.OfType<Light>().Select(lamp => $"{lamp.type} {lamp.intensity:R} {lamp.color}"));
        string bake = string.Join(" ", thing.Components.OfType<Sssgen.SssgenInnerLight>().Select(inside => $"{inside.bake.name} {inside.facts.name}"));
        Console.WriteLine($"{thing.name}\t{thing.transform.position}\t{thing.transform.Target}\t{thing.transform.localScale}\t{material}{light}\t{bake}");
    }
}
