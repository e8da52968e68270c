// How a body responds to light from anywhere, and its sum for some lights and surroundings. Places and directions are those of
// the bake: the body's object space as the mesh's file has it. Sssgen's light_response.py explains the numbers of the file.
namespace Sssgen {
    using System;
    using System.Collections.Generic;
    using System.IO;
    using System.IO.Compression;
    using UnityEngine;
    using UnityEngine.Rendering;

    /// <summary>A light at a body.</summary>
    public struct InnerLamp {
        /// <summary>The irradiance on a plane that faces it, where 1 makes a white matt surface white.</summary>
        public Vector3 Color;
        /// <summary>Where it is, or the direction towards it if it has no Share.</summary>
        public Vector3 Place;
        /// <summary>What is left of its colour at a place; null for a distant light.</summary>
        public Func<Vector3, float> Share;
    }

    /// <summary>The response of a body.</summary>
    public sealed class LightResponse {
        /// <summary>The root of light that has not been scattered, relative to its irradiance.</summary>
        private const float Unscattered = 0.25f;
        private const int Harmonics = 9;

        public readonly int Width, Height, Depth;
        /// <summary>The parameters of the technique, by their names there.</summary>
        public readonly Dictionary<string, float[]> Parameters;

        private readonly int count, rank, side, arrivingSide;
        private readonly Vector3[] places;
        private readonly int[] nearest;
        private readonly ushort[] distance;
        /// <summary>By number, then voxel.</summary>
        private readonly byte[] latents;
        /// <summary>By direction, number and channel.</summary>
        private readonly float[] table;
        /// <summary>By voxel, then direction.</summary>
        private readonly byte[] arriving;
        /// <summary>By harmonic, channel and voxel.</summary>
        private readonly float[] around;
        /// <summary>By channel, the light for each stored root.</summary>
        private readonly float[][] shares = new float[3][];
        private readonly float[][] sum = new float[3][];
        private readonly float[] row;
        private readonly int[] corners = new int[4];
        private readonly float[] weights = new float[4];

        /// <summary>The response of a file and its JSON; null where they are of another kind.</summary>
        public static LightResponse Of(byte[] file, string json) {
            try {
                var facts = new InnerFacts(json);
                return facts.FileBytes == file.Length ? new LightResponse(Decompressed(file), facts) : null;
            } catch (Exception error) when (error is FormatException || error is KeyNotFoundException
                || error is InvalidDataException || error is IOException) { // what is not compressed, as .NET and Mono have it
                return null;
            }
        }

        private static byte[] Decompressed(byte[] file) {
            if (file.Length < 2) {
                throw new InvalidDataException();
            }
            // two bytes of zlib are before what is compressed
            using (var stream = new DeflateStream(new MemoryStream(file, 2, file.Length - 2), CompressionMode.Decompress))
            using (var result = new MemoryStream()) {
                stream.CopyTo(result);
                return result.ToArray();
            }
        }

        private LightResponse(byte[] data, InnerFacts facts) {
            int[] shape = facts.Shape("nearest");
            Width = shape[2];
            Height = shape[1];
            Depth = shape[0];
            Parameters = facts.Parameters;
            nearest = facts.Integers(data, "nearest");
            int[] cells = facts.Integers(data, "cells");
            count = cells.Length;
            latents = facts.Bytes(data, "latents");
            rank = latents.Length / count;
            arriving = facts.Bytes(data, "arriving");
            side = Side(facts.Shape("table")[0]);
            arrivingSide = Side(facts.Shape("arriving")[1]);
            table = Array.ConvertAll(facts.Integers(data, "table"), half => Mathf.HalfToFloat((ushort)half));
            row = new float[3 * (1 + rank)];
            distance = Array.ConvertAll(facts.Bytes(data, "distance"), stored => Mathf.FloatToHalf(stored / 255f));
            places = Places(cells, facts.Numbers("box_min"), facts.Numbers("box_max"));
            around = Around(facts.Bytes(data, "surroundings"), facts.Numbers("largest"));
            float[] powers = facts.Numbers("powers");
            float highest = facts.Numbers("highest")[0];
            for (int channel = 0; channel < 3; channel++) {
                sum[channel] = new float[count];
                shares[channel] = new float[256];
                for (int root = 0; root < 256; root++) {
                    shares[channel][root] = Unscattered * ArrivingShare(root * highest / 255, powers[channel]);
                }
            }
        }

        private static int Side(int directions) {
            return Mathf.RoundToInt(Mathf.Sqrt(directions));
        }

        private Vector3[] Places(int[] cells, float[] low, float[] high) {
            return Array.ConvertAll(cells, cell => new Vector3(
                low[0] + (cell % Width + 0.5f) / Width * (high[0] - low[0]),
                low[1] + (cell / Width % Height + 0.5f) / Height * (high[1] - low[1]),
                low[2] + (cell / (Width * Height) + 0.5f) / Depth * (high[2] - low[2])));
        }

        private float[] Around(byte[] stored, float[] largest) {
            var result = new float[stored.Length];
            for (int i = 0; i < stored.Length; i++) {
                result[i] = (sbyte)stored[i] * largest[i / count] / 127;
            }
            return result;
        }

        /// <summary>Computes the light in all texels, four half floats each.</summary>
        /// <param name="surroundings">For each harmonic the integral of the light.</param>
        public void Light(List<InnerLamp> lamps, Vector3[] surroundings, ushort[] texels) {
            for (int channel = 0; channel < 3; channel++) {
                Array.Clear(sum[channel], 0, count);
                for (int harmonic = 0; harmonic < Harmonics; harmonic++) {
                    float weight = Part(surroundings[harmonic], channel);
                    int first = (3 * harmonic + channel) * count;
                    for (int voxel = 0; weight != 0 && voxel < count; voxel++) {
                        sum[channel][voxel] += weight * around[first + voxel];
                    }
                }
            }
            foreach (InnerLamp lamp in lamps) {
                if (lamp.Share == null) {
                    AddDistant(lamp);
                } else {
                    AddNear(lamp);
                }
            }
            var halves = new ushort[count];
            for (int channel = 0; channel < 3; channel++) {
                for (int voxel = 0; voxel < count; voxel++) {
                    halves[voxel] = Mathf.FloatToHalf(Mathf.Clamp(sum[channel][voxel], 0, 65504));
                }
                for (int texel = 0; texel < nearest.Length; texel++) {
                    texels[4 * texel + channel] = halves[nearest[texel]];
                }
            }
            for (int texel = 0; texel < distance.Length; texel++) {
                texels[4 * texel + 3] = distance[texel];
            }
        }

        /// <summary>Adds a distant light, number by number: so the stored ones lie in memory.</summary>
        private void AddDistant(InnerLamp lamp) {
            Look(lamp.Place);
            Mix(lamp.Place, arrivingSide);
            int directions = arrivingSide * arrivingSide;
            for (int channel = 0; channel < 3; channel++) {
                float strength = Part(lamp.Color, channel), start = strength * row[channel];
                float[] light = sum[channel], share = shares[channel];
                for (int voxel = 0; voxel < count; voxel++) {
                    light[voxel] += start;
                }
                for (int voxel = 0; directions > 0 && voxel < count; voxel++) {
                    light[voxel] += strength * share[Root(voxel * directions)];
                }
                for (int number = 0; number < rank; number++) {
                    float weight = strength * row[3 * (number + 1) + channel] / 255;
                    int first = number * count;
                    for (int voxel = 0; voxel < count; voxel++) {
                        light[voxel] += weight * latents[first + voxel];
                    }
                }
            }
        }

        private void AddNear(InnerLamp lamp) {
            int directions = arrivingSide * arrivingSide;
            for (int voxel = 0; voxel < count; voxel++) {
                float strength = lamp.Share(places[voxel]);
                if (strength == 0) {
                    continue;
                }
                Vector3 way = lamp.Place - places[voxel];
                Look(way);
                Mix(way, arrivingSide);
                int root = directions > 0 ? Root(voxel * directions) : 0;
                for (int channel = 0; channel < 3; channel++) {
                    float light = row[channel] + (directions > 0 ? shares[channel][root] : 0);
                    for (int number = 0; number < rank; number++) {
                        light += row[3 * (number + 1) + channel] * latents[number * count + voxel] / 255;
                    }
                    sum[channel][voxel] += strength * Part(lamp.Color, channel) * light;
                }
            }
        }

        /// <summary>The share of a channel. One above 1 is light that a curved surface focuses: the same for all channels.</summary>
        private static float ArrivingShare(float root, float power) {
            float share = Mathf.Max(root * root, 1e-9f);
            return share < 1 ? Mathf.Pow(share, power) : share;
        }

        /// <summary>The stored root between the mixed texels of a voxel.</summary>
        private int Root(int first) {
            float root = 0.5f;
            for (int corner = 0; corner < 4; corner++) {
                root += weights[corner] * arriving[first + corners[corner]];
            }
            return (int)root;
        }

        /// <summary>Puts the numbers of the table for a direction into the row.</summary>
        private void Look(Vector3 way) {
            Mix(way, side);
            for (int i = 0; i < row.Length; i++) {
                row[i] = 0;
                for (int corner = 0; corner < 4; corner++) {
                    row[i] += weights[corner] * table[corners[corner] * row.Length + i];
                }
            }
        }

        /// <summary>Finds the four texels of an octahedral map around a direction of any length, and their weights.</summary>
        private void Mix(Vector3 way, int side) {
            float whole = Mathf.Max(Mathf.Abs(way.x) + Mathf.Abs(way.y) + Mathf.Abs(way.z), 1e-20f);
            float across = way.x / whole, up = way.y / whole;
            if (way.z < 0) {
                float flat = across;
                across = (1 - Mathf.Abs(up)) * (way.x < 0 ? -1 : 1);
                up = (1 - Mathf.Abs(flat)) * (way.y < 0 ? -1 : 1);
            }
            float column = (0.5f * across + 0.5f) * side - 0.5f, line = (0.5f * up + 0.5f) * side - 0.5f;
            int left = Mathf.FloorToInt(column), low = Mathf.FloorToInt(line);
            float right = column - left, high = line - low;
            for (int corner = 0; corner < 4; corner++) {
                int i = corner & 1, j = corner >> 1;
                corners[corner] = Texel(left + i, low + j, side);
                weights[corner] = (i == 1 ? right : 1 - right) * (j == 1 ? high : 1 - high);
            }
        }

        /// <summary>Beyond an edge lies the same edge, reversed.</summary>
        private static int Texel(int column, int line, int side) {
            bool beside = column < 0 || column >= side, above = line < 0 || line >= side;
            int x = above && !beside ? side - 1 - column : column, y = beside && !above ? side - 1 - line : line;
            return Mathf.Clamp(y, 0, side - 1) * side + Mathf.Clamp(x, 0, side - 1);
        }

        private static float Part(Vector3 color, int channel) {
            return channel == 0 ? color.x : channel == 1 ? color.y : color.z;
        }
    }

    /// <summary>The surroundings of a body.</summary>
    public static class InnerSky {
        /// <summary>Directions that are spread evenly over the sphere (Fibonacci).</summary>
        private const int Count = 128;
        private static readonly Vector3[] Ways = new Vector3[Count];
        /// <summary>The factors of the polynomials in the real spherical harmonics.</summary>
        private static readonly float[] Factors = {
            0.28209479f, 0.48860251f, 0.48860251f, 0.48860251f, 1.09254843f, 1.09254843f, 0.31539157f, 1.09254843f, 0.54627422f,
        };

        static InnerSky() {
            for (int i = 0; i < Count; i++) {
                float y = 1 - (2f * i + 1) / Count, across = Mathf.Sqrt(1 - y * y), angle = i * Mathf.PI * (3 - Mathf.Sqrt(5));
                Ways[i] = new Vector3(across * Mathf.Cos(angle), y, across * Mathf.Sin(angle));
            }
        }

        /// <summary>
        /// The integrals of the light times the harmonics in the space of the bake, from what white matt surfaces show: the cosine
        /// leaves π, 2/3 π and π/4 of the orders (Ramamoorthi and Hanrahan 2001).
        /// </summary>
        public static Vector3[] Integrals(SphericalHarmonicsL2 probe, Matrix4x4 toWorld) {
            var sums = new Vector3[Factors.Length];
            foreach (Vector3 way in Ways) {
                Vector3 color = Shown(probe, toWorld.MultiplyVector(way).normalized);
                float[] values = Polynomials(way);
                for (int harmonic = 0; harmonic < sums.Length; harmonic++) {
                    float overCosine = harmonic == 0 ? 1 : harmonic < 4 ? 1.5f : 4;
                    sums[harmonic] += 4 * overCosine / Count * Factors[harmonic] * values[harmonic] * color;
                }
            }
            return sums;
        }

        /// <summary>What a white matt surface shows, as Unity's shaders evaluate a probe.</summary>
        private static Vector3 Shown(SphericalHarmonicsL2 probe, Vector3 normal) {
            float[] values = Polynomials(normal);
            Vector3 color = Vector3.zero;
            for (int i = 0; i < values.Length; i++) {
                color += values[i] * new Vector3(probe[0, i], probe[1, i], probe[2, i]);
            }
            return color;
        }

        private static float[] Polynomials(Vector3 way) {
            float x = way.x, y = way.y, z = way.z;
            return new[] { 1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y };
        }
    }
}
