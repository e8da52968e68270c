// Draws one frame of a scene with the feature, as far as there is no device: reads the scene, a row for each thing, from the
// standard input, and writes the commands and the values of the renderers as rows.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.Rendering.Universal;

public static class Frame {
    private static readonly Shader shader = new Shader();
    private static readonly Camera camera = new Camera();
    private static RenderTextureDescriptor size;

    public static void Main() {
        CultureInfo.DefaultThreadCurrentCulture = CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        for (string row; (row = Console.ReadLine()) != null;) {
            Read(row.Split('\t'));
        }
        var feature = new Sssgen.SssgenPasses();
        feature.Create();
        for (int frame = 0; frame < 2; frame++) { // the second one gives back what the first one lent
            IEnumerable<object[]> commands = Draw(feature).ToList();
            if (frame == 1) {
                foreach (object[] command in commands) {
                    Write(command);
                }
                foreach (Renderer renderer in UnityEngine.Object.Scene.OfType<Renderer>()) {
                    foreach (var value in renderer.Values) {
                        Write("value", renderer, value.Key, value.Value);
                    }
                }
            }
        }
        foreach (string warning in Debug.Warnings) {
            Write("warning", warning);
        }
        feature.Dispose();
        Write("lent", RenderTexture.Lent.Count);
    }

    private static IEnumerable<object[]> Draw(ScriptableRendererFeature feature) {
        var renderer = new ScriptableRenderer();
        var data = new RenderingData();
        feature.OnCameraPreCull(renderer, new CameraData { camera = camera, cameraTargetDescriptor = size });
        feature.AddRenderPasses(renderer, ref data);
        Time.realtimeSinceStartup += 1; // so that the feature searches for bodies again
        return renderer.Passes.OrderBy(pass => pass.renderPassEvent).SelectMany(pass => Draw(pass, data));
    }

    private static IEnumerable<object[]> Draw(ScriptableRenderPass pass, RenderingData data) {
        yield return new object[] { "pass", pass.renderPassEvent };
#if UNITY_6000_0_OR_NEWER && !URP_COMPATIBILITY_MODE
        var graph = new UnityEngine.Rendering.RenderGraphModule.RenderGraph();
        pass.RecordRenderGraph(graph, new ContextContainer());
        foreach (object[] row in graph.Done.Rows) yield return row;
#else
#pragma warning disable 612 // obsolete in Unity 6
        var context = new ScriptableRenderContext();
        pass.OnCameraSetup(new CommandBuffer(), ref data);
        if (pass.Target == null) throw new InvalidOperationException("URP would bind the camera's target");
        pass.Execute(context, ref data);
        foreach (object[] row in context.Done.Rows) yield return row;
#endif
    }

    private static void Read(string[] row) {
        float[] numbers = row.Skip(2).Where(text => float.TryParse(text, out _)).Select(float.Parse).ToArray();
        switch (row[0]) {
            case "pass":
                shader.Passes.Add(Enumerable.Range(0, row.Length / 2).ToDictionary(i => row[2 * i + 1], i => row[2 * i + 2]));
                break;
            case "tag":
                shader.Tags[row[1]] = row[2];
                break;
            case "light":
                var light = new Light {
                    type = (LightType)Enum.Parse(typeof(LightType), row[1]),
                    color = new Color(numbers[6], numbers[7], numbers[8]), spotAngle = numbers[9], range = numbers[10],
                };
                light.transform.position = Vector(numbers, 0);
                light.transform.forward = Vector(numbers, 3);
                UnityEngine.Object.Scene.Add(light);
                break;
            case "body":
                var material = new Material { shader = shader, name = "material " + UnityEngine.Object.Scene.Count };
                if (row[1] != "") material.Textures[Shader.PropertyToID(row[1])] = new RenderTexture(1, 1, 0);
                UnityEngine.Object.Scene.Add(new Renderer {
                    bounds = new Bounds(Vector(numbers, 0), Vector(numbers, 3)), Materials = new[] { null, material },
                });
                break;
            case "camera":
                size = new RenderTextureDescriptor { width = (int)numbers[0], height = (int)numbers[1] };
                camera.transform.position = Vector(numbers, 2);
                camera.worldToCameraMatrix = Matrix(numbers, 5);
                camera.projectionMatrix = Matrix(numbers, 21);
                break;
        }
    }

    private static Vector3 Vector(float[] numbers, int at) => new Vector3(numbers[at], numbers[at + 1], numbers[at + 2]);

    private static Matrix4x4 Matrix(float[] numbers, int at) {
        var result = new Matrix4x4();
        for (int i = 0; i < 4; i++, at += 4) {
            result.SetRow(i, new Vector4(numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]));
        }
        return result;
    }

    private static void Write(params object[] row) {
        int name = new[] { "", "set", "texture", "value" }.ToList().IndexOf((string)row[0]) < 1 ? -1 : (string)row[0] == "value" ? 2 : 1;
        Console.WriteLine(string.Join("\t", row.Select((value, i) => i == name ? Shader.NameOf((int)value) : Text(value))));
    }

    private static string Text(object value) {
        if (value is Renderer) return UnityEngine.Object.Scene.OfType<Renderer>().ToList().IndexOf((Renderer)value).ToString();
        if (value is RenderTexture) return Text((RenderTexture)value);
        if (value is Matrix4x4) return string.Join(" ", Enumerable.Range(0, 4).Select(i => Text(((Matrix4x4)value).GetRow(i))));
        if (value is Vector4) return Text((Vector4)value);
        return value is float ? ((float)value).ToString("R") : value.ToString();
    }

    private static string Text(RenderTexture texture) =>
        $"{texture.Number} {texture.width} {texture.height} {texture.format} {texture.filterMode} {texture.wrapMode}";

    private static string Text(Vector4 vector) => $"{vector.x:R} {vector.y:R} {vector.z:R} {vector.w:R}";
}
