// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for Babylon.js. Change the material and emit it again rather than this file.

import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import type { BaseTexture } from '@babylonjs/core/Materials/Textures/baseTexture.js';
import type { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import type { Matrix, Vector2, Vector3, Vector4 } from '@babylonjs/core/Maths/math.vector.js';
import type { Scene } from '@babylonjs/core/scene.js';

/** What createMaterial takes, beside the properties of PBRMaterial. */
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
  attenuationDistance?: number;
  /** Multiplies the texture. Default 0.75, 0.9, 1.0, 1.0. */
  tint?: Vector4 | Color4 | number[];
  /** 0 = not a metal, 1 = metal. Default 0.0. Range 0.0 to 1.0. */
  metalness?: number;
  /** 0 = smooth as a mirror, 1 = rough as chalk. Default 0.12. Range 0.0 to 1.0. */
  surfaceRoughness?: number;
  /** Height of the thickest cells above their edges. Default 0.01. Range 0.0 to 1.0. Unit m. */
  relief?: number;
  /** Change of the texture coordinates per world unit along T and along B. Default 1.0, 1.0. Unit 1/m. */
  uvPerUnit?: Vector2 | number[];
  /** Multiplies the texture. Default 1.0. Range 0.0 to 1.0. */
  cover?: number;
  /** Velocity of the red layer. Default 0.02, 0.0. Unit 1/s. */
  redSpeed?: Vector2 | number[];
  /** Velocity of the green layer. Default -0.01, 0.015. Unit 1/s. */
  greenSpeed?: Vector2 | number[];
  /** Velocity of the blue layer. Default 0.0, -0.025. Unit 1/s. */
  blueSpeed?: Vector2 | number[];
  /** Colour of the light in the red and green layers, where both are bright. Default 0.3, 0.8, 1.0. */
  veinColor?: Color3 | string | number[];
  /** Colour of the light in the blue layer. Default 0.6, 0.9, 1.0. */
  sparkColor?: Color3 | string | number[];
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
  subsurfaceColor?: Color3 | string | number[];
  /** Factor on the whole result. Default 0.8. Range 0.0 to 1.0. */
  attenuation?: number;
  /** Strength of the glow towards the light. Default 2.0. Range 0.0 to 20.0. */
  scale?: number;
  /** Glow that does not depend on the direction. Default 0.12. Range 0.0 to 1.0. */
  ambient?: number;
  /** How narrow the glow around the light is: the larger, the smaller the spot. Default 6.0. Range 1.0 to 32.0. */
  power?: number;
  /** Colour of the surface (an sRGB texture), with its opacity in alpha. */
  baseColorTexture?: BaseTexture | string | null;
  /** Cover on the ice (snow, rock): black = bare ice, white = covered. */
  coverTexture?: BaseTexture | string | null;
  /** Three pictures in one texture: red, green and blue each hold a layer. */
  packedTexture?: BaseTexture | string | null;
  /** Mask of the erosion: dark parts disappear first. */
  erosionTexture?: BaseTexture | string | null;
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
  color: boolean;
  /** What to do for it, where a picture without it is wrong. */
  needed?: string;
  name: string;
}

export const parameters: Record<"variation" | "cellCount" | "thicknessFactor" | "bevel" | "attenuationDistance" | "tint" | "metalness" | "surfaceRoughness" | "relief" | "uvPerUnit" | "cover" | "redSpeed" | "greenSpeed" | "blueSpeed" | "veinColor" | "sparkColor" | "texelSize" | "edge" | "erosion" | "edgeHeight" | "distortion" | "subsurfaceColor" | "attenuation" | "scale" | "ambient" | "power", Parameter>;
export const textures: Record<"baseColorTexture" | "coverTexture" | "packedTexture" | "erosionTexture", TextureParameter>;

/** Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes that melt into it. */
export class IceMaterial extends PBRMaterial {
  constructor(values?: IceMaterialValues & Partial<PBRMaterial>, scene?: Scene);
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
  get attenuationDistance(): number;
  set attenuationDistance(value: number);
  /** Multiplies the texture. Default 0.75, 0.9, 1.0, 1.0. */
  get tint(): Vector4;
  set tint(value: Vector4 | Color4 | number[]);
  /** 0 = not a metal, 1 = metal. Default 0.0. Range 0.0 to 1.0. */
  get metalness(): number;
  set metalness(value: number);
  /** 0 = smooth as a mirror, 1 = rough as chalk. Default 0.12. Range 0.0 to 1.0. */
  get surfaceRoughness(): number;
  set surfaceRoughness(value: number);
  /** Height of the thickest cells above their edges. Default 0.01. Range 0.0 to 1.0. Unit m. */
  get relief(): number;
  set relief(value: number);
  /** Change of the texture coordinates per world unit along T and along B. Default 1.0, 1.0. Unit 1/m. */
  get uvPerUnit(): Vector2;
  set uvPerUnit(value: Vector2 | number[]);
  /** Multiplies the texture. Default 1.0. Range 0.0 to 1.0. */
  get cover(): number;
  set cover(value: number);
  /** Velocity of the red layer. Default 0.02, 0.0. Unit 1/s. */
  get redSpeed(): Vector2;
  set redSpeed(value: Vector2 | number[]);
  /** Velocity of the green layer. Default -0.01, 0.015. Unit 1/s. */
  get greenSpeed(): Vector2;
  set greenSpeed(value: Vector2 | number[]);
  /** Velocity of the blue layer. Default 0.0, -0.025. Unit 1/s. */
  get blueSpeed(): Vector2;
  set blueSpeed(value: Vector2 | number[]);
  /** Colour of the light in the red and green layers, where both are bright. Default 0.3, 0.8, 1.0. */
  get veinColor(): Color3;
  set veinColor(value: Color3 | string | number[]);
  /** Colour of the light in the blue layer. Default 0.6, 0.9, 1.0. */
  get sparkColor(): Color3;
  set sparkColor(value: Color3 | string | number[]);
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
  get subsurfaceColor(): Color3;
  set subsurfaceColor(value: Color3 | string | number[]);
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
  get baseColorTexture(): BaseTexture;
  set baseColorTexture(value: BaseTexture | string | null);
  /** Cover on the ice (snow, rock): black = bare ice, white = covered. */
  get coverTexture(): BaseTexture;
  set coverTexture(value: BaseTexture | string | null);
  /** Three pictures in one texture: red, green and blue each hold a layer. */
  get packedTexture(): BaseTexture;
  set packedTexture(value: BaseTexture | string | null);
  /** Mask of the erosion: dark parts disappear first. */
  get erosionTexture(): BaseTexture;
  set erosionTexture(value: BaseTexture | string | null);
  /** In seconds; null: the page's clock. */
  time: number | null;
  clone(name: string, cloneTexturesOnlyOnce?: boolean, rootUrl?: string): IceMaterial;
}

/** The material, for WebGL 2 and WebGPU. `scene`: else the last one. */
export function createMaterial(values?: IceMaterialValues & Partial<PBRMaterial>, scene?: Scene): IceMaterial;
