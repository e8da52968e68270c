// What Python sends to the page: emitted_head.py, flat_head.py and picture.py make the pictures, page_messages.py the messages.

/** A parameter of the material. */
export interface Control {
  property: string;
  technique: string;
  name: string;
  label: string;
  doc: string;
  type: string;
  range: [number, number] | null;
  unit: string;
  color: boolean;
  /** A letter for each component of a vector. */
  channels: string;
  /** The key of the medium's look that it follows from, or ''. */
  look: '' | 'color' | 'depth';
  default: number[];
  value: number[];
  drawn: string;
  /** Whether the object places it. */
  placed: boolean;
  in_scene: boolean;
}

/** Half floats with four channels; `data` is the digest of a level. */
export interface Texels {
  dim: '2D' | '3D';
  filter: 'linear' | 'nearest';
  wrap: 'repeat' | 'clamp' | 'mirror';
  levels: { size: number[]; data: string }[];
}

/** A texture of the material. */
export interface Slot {
  property: string;
  source_name: string;
  technique: string;
  name: string;
  doc: string;
  type: string;
  color: boolean;
  drawn: string;
  page_draws: boolean;
  texels?: Texels;
  /** The name of the user's file, or ''. */
  chosen?: string;
}

/** A picture of one triangle; `given` has, for a uniform's name, what the page gives: its time, its mouse. */
export interface Flat {
  vertex: string;
  fragment: string;
  given: Record<string, string>;
  start: number;
  plays: boolean;
}

interface AnyPicture {
  name: string;
  title: string;
  shape: string;
  shapes: string[];
  mesh: string;
  note?: string;
  /** Where the mesh does not suit the material. */
  warnings?: string[];
  body?: string;
  /** Why its values cannot be saved, or ''. */
  saves: string;
  /** Whether it can be saved under another name. */
  copies?: boolean;
  /** Where its values are saved. */
  saved_in?: string;
  /** Files that are missing, with the command that makes them. */
  missing?: string;
  controls: Control[];
  textures: Slot[];
  cost: Record<string, Record<string, number>>;
  /** The light from all around that the scene's file names. */
  environment?: Texels | null;
  exposure: number;
}

export interface FlatPicture extends AnyPicture {
  flat: Flat;
}

/** A body with a material. `body` is the digest of its triangles, `model` a matrix by columns; colours are linear. */
export interface BodyPicture extends AnyPicture {
  flat?: undefined;
  module: string;
  two_sided: boolean;
  body: string;
  model: number[];
  lights: Light[];
  lamp_passes: { seen_from: string; views: number }[];
  ambient: Vector3;
  background: Vector3[];
  shadows: boolean;
  tone_mapping: string;
  camera: { position: Vector3; target: Vector3; field_of_view: number };
}

/** A lamp: `position` ends with 1, or the direction of one from afar with 0; `color` is its radiance, at a place that at a distance of 1. */
export interface Light {
  position: number[];
  color: number[];
}

type Vector3 = [number, number, number];
type Vector4 = [number, number, number, number];

export type Picture = FlatPicture | BodyPicture;

/** A picture for one pane. */
export interface PictureMessage {
  kind: 'picture';
  picture: Picture;
  version: number;
  error: string;
  label: string;
  /** The files of the last change that can be taken back, or ''. */
  undoes: string;
  stages: StageRow[];
  pane: number;
  panes: number;
  beside: string;
  besides: Record<string, string>;
  limit: number;
}

/** A stage of the chain, with its place in the file. */
export interface StageRow {
  path: (string | number)[];
  technique: string;
  role: string;
  doc: string;
  /** Whether the menus change it. */
  changes: boolean;
}

/** A technique in a menu; `reason` is why the chain does not link with it, or ''. */
export interface TechniqueRow {
  name: string;
  role: string;
  section: string;
  summary: string;
  needs: string[];
  baseline: boolean;
  reason: string;
}

/** The emitted text; `sources` has, for a line's number, its place as `file:line:column`. */
export interface TextMessage {
  kind: 'text';
  targets: string[];
  target: string;
  form: string;
  files: { name: string; text: string; sources: Record<number, string> }[];
  error: string;
}

export interface SourceMessage {
  kind: 'source';
  name: string;
  text: string;
  note: string;
}

/** The bytes of a digest. */
export type PieceOf = (digest: string) => Promise<ArrayBuffer>;

/** Property → the numbers that differ from the file's. */
export type Values = Map<string, number[]>;
