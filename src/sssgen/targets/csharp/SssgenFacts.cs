// The JSON beside a bake: the parameters of the technique, and where the arrays are in the file.
namespace Sssgen {
    using System;
    using System.Collections.Generic;
    using System.Globalization;
    using System.Text.RegularExpressions;

    /// <summary>The facts of a file of `sssgen bake fluence --relit`.</summary>
    public sealed class InnerFacts {
        // a text, a number, a word or a mark
        private static readonly Regex Token = new Regex(@"\G\s*(""(?:[^""\\]|\\.)*""|-?[0-9][0-9.eE+-]*|[a-zA-Z]+|[][{},:])");
        private readonly string json;
        private readonly Dictionary<string, object> facts;
        private int at;

        public readonly Dictionary<string, float[]> Parameters = new Dictionary<string, float[]>();

        /// <summary>Throws FormatException or KeyNotFoundException for the JSON of another file.</summary>
        public InnerFacts(string json) {
            this.json = json;
            facts = Table(Value());
            foreach (var parameter in Table(facts["parameters"])) {
                Parameters[parameter.Key] = Numbers(parameter.Value);
            }
        }

        /// <summary>The property of a parameter: `_WorldToVolume` for `world_to_volume`.</summary>
        public static string PropertyOf(string name) {
            return Regex.Replace("_" + name, "_(.)", letter => letter.Groups[1].Value.ToUpperInvariant()).Insert(0, "_");
        }

        /// <summary>The size of the file that this JSON describes.</summary>
        public int FileBytes => (int)Numbers(Table(facts["file"])["bytes"])[0];

        /// <summary>The numbers of an entry, those of inner lists one behind the other.</summary>
        public float[] Numbers(string name) {
            return Numbers(facts[name]);
        }

        public int[] Shape(string array) {
            return Array.ConvertAll(Numbers(About(array)["shape"]), extent => (int)extent);
        }

        public byte[] Bytes(byte[] data, string array) {
            string type = About(array)["type"] as string;
            return Part(data, array, type == "uint32" ? 4 : type == "uint16" || type == "float16" ? 2 : 1);
        }

        /// <summary>An array of whole numbers, or of the bits of half floats.</summary>
        public int[] Integers(byte[] data, string array) {
            byte[] bytes = Bytes(data, array);
            bool large = About(array)["type"] as string == "uint32";
            var result = new int[bytes.Length / (large ? 4 : 2)];
            for (int i = 0; i < result.Length; i++) {
                result[i] = large ? BitConverter.ToInt32(bytes, 4 * i) : BitConverter.ToUInt16(bytes, 2 * i);
            }
            return result;
        }

        private byte[] Part(byte[] data, string array, int size) {
            foreach (int extent in Shape(array)) {
                size *= extent;
            }
            int start = (int)Numbers(About(array)["start"])[0];
            if (start + size > data.Length) {
                throw new FormatException("the file ends too early");
            }
            var result = new byte[size];
            Array.Copy(data, start, result, 0, size);
            return result;
        }

        private Dictionary<string, object> About(string array) {
            return Table(Table(facts["arrays"])[array]);
        }

        private static Dictionary<string, object> Table(object value) {
            return value as Dictionary<string, object> ?? throw new FormatException("a table is missing");
        }

        private static float[] Numbers(object value) {
            if (value is List<object> list) {
                var numbers = new List<float>();
                list.ForEach(part => numbers.AddRange(Numbers(part)));
                return numbers.ToArray();
            }
            return value is double number ? new[] { (float)number } : throw new FormatException("a number is missing");
        }

        private object Value() {
            string token = Next();
            if (token == "{") {
                var table = new Dictionary<string, object>();
                for (token = Next(); token != "}"; token = Next()) {
                    if (token == ",") {
                        continue;
                    }
                    Expect(Next(), ":");
                    table[token.Trim('"')] = Value();
                }
                return table;
            }
            if (token == "[") {
                var list = new List<object>();
                while (Peek() != "]") {
                    list.Add(Value());
                    if (Peek() == ",") {
                        Next();
                    }
                }
                Next();
                return list;
            }
            if (token[0] == '"') {
                return token.Trim('"');
            }
            return double.TryParse(token, NumberStyles.Float, CultureInfo.InvariantCulture, out double number) ? (object)number : token;
        }

        private string Peek() {
            int start = at;
            string token = Next();
            at = start;
            return token;
        }

        private string Next() {
            Match found = Token.Match(json, at);
            if (!found.Success) {
                throw new FormatException("this is no JSON");
            }
            at = found.Index + found.Length;
            return found.Groups[1].Value;
        }

        private static void Expect(string token, string mark) {
            if (token != mark) {
                throw new FormatException($"'{mark}' is missing");
            }
        }
    }
}
