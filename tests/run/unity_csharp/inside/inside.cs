// Gives a body the component of the light inside, as far as there is no device: reads rows from the standard input, and for
// each row `frame` writes how often the volume was computed, its texels, and the values of the renderer.
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using UnityEngine;

public static class Inside {
    private static readonly Renderer body = new Renderer();
    private static readonly Sssgen.SssgenInnerLight component = new Sssgen.SssgenInnerLight { name = "body" };

    public static void Main() {
        CultureInfo.DefaultThreadCurrentCulture = CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        UnityEngine.Object.Scene.Add(body);
        for (string line; (line = Console.ReadLine()) != null;) {
            string[] row = line.Split('\t');
            float[] numbers = row.Skip(1).Where(text => float.TryParse(text, out _)).Select(float.Parse).ToArray();
            switch (row[0]) {
                case "bake":
                    Set("bake", new TextAsset { name = row[1], bytes = File.ReadAllBytes(row[1]) });
                    Set("facts", new TextAsset { name = row[2], text = File.ReadAllText(row[2]) });
                    Set("mirrored", row[3] == "True");
                    Call("OnEnable");
                    break;
                case "place":
                    body.localToWorldMatrix = Matrix(numbers, 0);
                    body.worldToLocalMatrix = Matrix(numbers, 16);
                    break;
                case "probe":
                    for (int i = 0; i < 27; i++) RenderSettings.ambientProbe[i / 9, i % 9] = numbers[i];
                    break;
                case "dark":
                    UnityEngine.Object.Scene.RemoveAll(thing => thing is Light);
                    break;
                case "light":
                    var light = new Light {
                        type = (LightType)Enum.Parse(typeof(LightType), row[1]), range = numbers[9], spotAngle = numbers[10],
                        innerSpotAngle = numbers[11], useColorTemperature = row[1] == "Point", color = new Color(numbers[6], numbers[7], numbers[8]), intensity = 0.5f,
                    };
                    light.transform.position = new Vector3(numbers[0], numbers[1], numbers[2]);
                    light.transform.forward = new Vector3(numbers[3], numbers[4], numbers[5]);
                    UnityEngine.Object.Scene.Add(light);
                    break;
                case "frame":
                    Time.realtimeSinceStartup += 1;
                    Call("LateUpdate");
                    Write();
                    break;
            }
        }
        Call("OnDisable");
        foreach (string warning in Debug.Warnings) Console.WriteLine("warning\t" + warning);
    }

    private static void Set(string name, object value) =>
        typeof(Sssgen.SssgenInnerLight).GetField(name, BindingFlags.Instance | BindingFlags.NonPublic).SetValue(component, value);

    private static void Call(string name) =>
        typeof(Sssgen.SssgenInnerLight).GetMethod(name, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(component, null);

    private static void Write() {
        foreach (var value in body.Values) {
            string text = value.Value is Texture3D volume ? Text(volume) : Text(value.Value);
            Console.WriteLine($"value\t{Shader.NameOf(value.Key)}\t{text}");
        }
        Console.WriteLine("end");
    }

    private static string Text(Texture3D volume) {
        var bytes = new byte[2 * volume.Texels.Length];
        Buffer.BlockCopy(volume.Texels, 0, bytes, 0, bytes.Length);
        return $"{volume.Applied} {Convert.ToBase64String(bytes)}";
    }

    private static string Text(object value) {
        if (value is Matrix4x4 matrix) return string.Join(" ", Enumerable.Range(0, 4).Select(row => Text(matrix.GetRow(row))));
        return value is Vector4 v ? $"{v.x:R} {v.y:R} {v.z:R} {v.w:R}" : ((float)value).ToString("R");
    }

    private static Matrix4x4 Matrix(float[] numbers, int at) {
        var result = new Matrix4x4();
        for (int row = 0; row < 4; row++, at += 4) {
            result.SetRow(row, new Vector4(numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]));
        }
        return result;
    }
}
