// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for three.js. Change the material and emit it again rather than this file.

import * as THREE from 'three/webgpu';

/** What createMaterial takes, beside the properties of MeshPhysicalMaterial. */
export interface IceMaterialValues {
  /** How much the levels of the cells differ: 0 = all are equal. Default 0.6. Range 0.0 to 1.0. */
  variation?: number;
  /** Number of cells along one unit of texture coordinate. Default 10.0. Range 1.0 to 200.0. */
  cellCount?: number;
  /** Thickness of a cell of level 1. Default 0.3. Range 0.0 to 10.0. Unit m. */
  thicknessFactor?: number;
  /** Width of the slope next to an edge, in cells. Default 0.35. Range 0.05 to 1.0. */
  bevel?: number;
  /** The length after which 1/e (37 %) of the light remains; 0 = opaque. Default 0.25. Range 0.0 to 10.0. Unit m. */
  sssAttenuationDistance?: number;
  /** Multiplies the texture. Default 0.75, 0.9, 1.0, 1.0. */
  tint?: THREE.Vector4 | number[];
  /** 0 = not a metal, 1 = metal. Default 0.0. Range 0.0 to 1.0. */
  sssMetalness?: number;
  /** 0 = smooth as a mirror, 1 = rough as chalk. Default 0.12. Range 0.0 to 1.0. */
  surfaceRoughness?: number;
  /** Height of the thickest cells above their edges. Default 0.01. Range 0.0 to 1.0. Unit m. */
  relief?: number;
  /** Change of the texture coordinates per world unit along T and along B. Default 1.0, 1.0. Unit 1/m. */
  uvPerUnit?: THREE.Vector2 | number[];
  /** Multiplies the texture. Default 1.0. Range 0.0 to 1.0. */
  cover?: number;
  /** Velocity of the red layer. Default 0.02, 0.0. Unit 1/s. */
  redSpeed?: THREE.Vector2 | number[];
  /** Velocity of the green layer. Default -0.01, 0.015. Unit 1/s. */
  greenSpeed?: THREE.Vector2 | number[];
  /** Velocity of the blue layer. Default 0.0, -0.025. Unit 1/s. */
  blueSpeed?: THREE.Vector2 | number[];
  /** Colour of the light in the red and green layers, where both are bright. Default 0.3, 0.8, 1.0. */
  veinColor?: THREE.Color | THREE.ColorRepresentation | number[];
  /** Colour of the light in the blue layer. Default 0.6, 0.9, 1.0. */
  sparkColor?: THREE.Color | THREE.ColorRepresentation | number[];
  /** The length, in texture coordinates, over which slopes are measured: about one texel. Default 0.002. Range 0.0001 to 0.1. */
  texelSize?: number;
  /** Width of the soft edge, in the texture's values. Default 0.15. Range 0.01 to 1.0. */
  edge?: number;
  /** How much is eroded: 0 = nothing, 1 = everything. Default 0.2. Range 0.0 to 1.0. */
  erosion?: number;
  /** Height of the step in the surface at the edge. Default 0.02. Range 0.0 to 1.0. Unit m. */
  edgeHeight?: number;
  /** How far the normal bends the light's direction inside the body: 0 ignores the shape. Default 0.2. Range 0.0 to 1.0. */
  distortion?: number;
  /** Colour of the transmitted light. Default 0.55, 0.85, 1.0. */
  subsurfaceColor?: THREE.Color | THREE.ColorRepresentation | number[];
  /** Factor on the whole result. Default 0.8. Range 0.0 to 1.0. */
  attenuation?: number;
  /** Strength of the glow towards the light. Default 2.0. Range 0.0 to 20.0. */
  scale?: number;
  /** Glow that does not depend on the direction. Default 0.12. Range 0.0 to 1.0. */
  ambient?: number;
  /** How narrow the glow around the light is: the larger, the smaller the spot. Default 6.0. Range 1.0 to 32.0. */
  power?: number;
  /** Colour of the surface (an sRGB texture), with its opacity in alpha. */
  baseColorTexture?: THREE.Texture | null;
  /** Cover on the ice (snow, rock): black = bare ice, white = covered. */
  coverTexture?: THREE.Texture | null;
  /** Three pictures in one texture: red, green and blue each hold a layer. */
  packedTexture?: THREE.Texture | null;
  /** Mask of the erosion: dark parts disappear first. */
  erosionTexture?: THREE.Texture | null;
  /** In seconds; null: the page's clock. */
  time?: number | null;
}

export interface Parameter {
  type: string;
  default: number | number[];
  color?: boolean;
  range?: number[];
  unit?: string;
  name: string;
}

export interface TextureParameter {
  type: string;
  default: 'white' | 'black' | 'gray' | 'bump';
  colorSpace: string;
  /** What to do for it, where a picture without it is wrong. */
  needed?: string;
  name: string;
}

export const parameters: Record<"variation" | "cellCount" | "thicknessFactor" | "bevel" | "sssAttenuationDistance" | "tint" | "sssMetalness" | "surfaceRoughness" | "relief" | "uvPerUnit" | "cover" | "redSpeed" | "greenSpeed" | "blueSpeed" | "veinColor" | "sparkColor" | "texelSize" | "edge" | "erosion" | "edgeHeight" | "distortion" | "subsurfaceColor" | "attenuation" | "scale" | "ambient" | "power", Parameter>;
export const textures: Record<"baseColorTexture" | "coverTexture" | "packedTexture" | "erosionTexture", TextureParameter>;

/** Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes that melt into it. */
export class IceMaterial extends THREE.MeshPhysicalMaterial {
  constructor(values?: IceMaterialValues & THREE.MeshPhysicalMaterialParameters);
  /** How much the levels of the cells differ: 0 = all are equal. Default 0.6. Range 0.0 to 1.0. */
  get variation(): number;
  set variation(value: number);
  /** Number of cells along one unit of texture coordinate. Default 10.0. Range 1.0 to 200.0. */
  get cellCount(): number;
  set cellCount(value: number);
  /** Thickness of a cell of level 1. Default 0.3. Range 0.0 to 10.0. Unit m. */
  get thicknessFactor(): number;
  set thicknessFactor(value: number);
  /** Width of the slope next to an edge, in cells. Default 0.35. Range 0.05 to 1.0. */
  get bevel(): number;
  set bevel(value: number);
  /** The length after which 1/e (37 %) of the light remains; 0 = opaque. Default 0.25. Range 0.0 to 10.0. Unit m. */
  get sssAttenuationDistance(): number;
  set sssAttenuationDistance(value: number);
  /** Multiplies the texture. Default 0.75, 0.9, 1.0, 1.0. */
  get tint(): THREE.Vector4;
  set tint(value: THREE.Vector4 | number[]);
  /** 0 = not a metal, 1 = metal. Default 0.0. Range 0.0 to 1.0. */
  get sssMetalness(): number;
  set sssMetalness(value: number);
  /** 0 = smooth as a mirror, 1 = rough as chalk. Default 0.12. Range 0.0 to 1.0. */
  get surfaceRoughness(): number;
  set surfaceRoughness(value: number);
  /** Height of the thickest cells above their edges. Default 0.01. Range 0.0 to 1.0. Unit m. */
  get relief(): number;
  set relief(value: number);
  /** Change of the texture coordinates per world unit along T and along B. Default 1.0, 1.0. Unit 1/m. */
  get uvPerUnit(): THREE.Vector2;
  set uvPerUnit(value: THREE.Vector2 | number[]);
  /** Multiplies the texture. Default 1.0. Range 0.0 to 1.0. */
  get cover(): number;
  set cover(value: number);
  /** Velocity of the red layer. Default 0.02, 0.0. Unit 1/s. */
  get redSpeed(): THREE.Vector2;
  set redSpeed(value: THREE.Vector2 | number[]);
  /** Velocity of the green layer. Default -0.01, 0.015. Unit 1/s. */
  get greenSpeed(): THREE.Vector2;
  set greenSpeed(value: THREE.Vector2 | number[]);
  /** Velocity of the blue layer. Default 0.0, -0.025. Unit 1/s. */
  get blueSpeed(): THREE.Vector2;
  set blueSpeed(value: THREE.Vector2 | number[]);
  /** Colour of the light in the red and green layers, where both are bright. Default 0.3, 0.8, 1.0. */
  get veinColor(): THREE.Color;
  set veinColor(value: THREE.Color | THREE.ColorRepresentation | number[]);
  /** Colour of the light in the blue layer. Default 0.6, 0.9, 1.0. */
  get sparkColor(): THREE.Color;
  set sparkColor(value: THREE.Color | THREE.ColorRepresentation | number[]);
  /** The length, in texture coordinates, over which slopes are measured: about one texel. Default 0.002. Range 0.0001 to 0.1. */
  get texelSize(): number;
  set texelSize(value: number);
  /** Width of the soft edge, in the texture's values. Default 0.15. Range 0.01 to 1.0. */
  get edge(): number;
  set edge(value: number);
  /** How much is eroded: 0 = nothing, 1 = everything. Default 0.2. Range 0.0 to 1.0. */
  get erosion(): number;
  set erosion(value: number);
  /** Height of the step in the surface at the edge. Default 0.02. Range 0.0 to 1.0. Unit m. */
  get edgeHeight(): number;
  set edgeHeight(value: number);
  /** How far the normal bends the light's direction inside the body: 0 ignores the shape. Default 0.2. Range 0.0 to 1.0. */
  get distortion(): number;
  set distortion(value: number);
  /** Colour of the transmitted light. Default 0.55, 0.85, 1.0. */
  get subsurfaceColor(): THREE.Color;
  set subsurfaceColor(value: THREE.Color | THREE.ColorRepresentation | number[]);
  /** Factor on the whole result. Default 0.8. Range 0.0 to 1.0. */
  get attenuation(): number;
  set attenuation(value: number);
  /** Strength of the glow towards the light. Default 2.0. Range 0.0 to 20.0. */
  get scale(): number;
  set scale(value: number);
  /** Glow that does not depend on the direction. Default 0.12. Range 0.0 to 1.0. */
  get ambient(): number;
  set ambient(value: number);
  /** How narrow the glow around the light is: the larger, the smaller the spot. Default 6.0. Range 1.0 to 32.0. */
  get power(): number;
  set power(value: number);
  /** Colour of the surface (an sRGB texture), with its opacity in alpha. */
  get baseColorTexture(): THREE.Texture;
  set baseColorTexture(value: THREE.Texture | null);
  /** Cover on the ice (snow, rock): black = bare ice, white = covered. */
  get coverTexture(): THREE.Texture;
  set coverTexture(value: THREE.Texture | null);
  /** Three pictures in one texture: red, green and blue each hold a layer. */
  get packedTexture(): THREE.Texture;
  set packedTexture(value: THREE.Texture | null);
  /** Mask of the erosion: dark parts disappear first. */
  get erosionTexture(): THREE.Texture;
  set erosionTexture(value: THREE.Texture | null);
  /** In seconds; null: the page's clock. */
  time: number | null;
}

/** The material, for WebGPURenderer and WebGLRenderer. */
export function createMaterial(values?: IceMaterialValues & THREE.MeshPhysicalMaterialParameters): IceMaterial;
