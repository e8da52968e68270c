// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for Bevy 0.20, an extended material. Change the material and emit it again rather than this file.
// Put ice.wesl into assets/shaders and this file beside main.rs, and add the plugin
// MaterialPlugin::<IceMaterial>::default() to the app.
use bevy::pbr::{ExtendedMaterial, MaterialExtension, OpaqueRendererMethod};
use bevy::prelude::*;
use bevy::render::render_resource::AsBindGroup;
use bevy::shader::ShaderRef;

/// The material: `base` has what the extension does not set.
pub type IceMaterial = ExtendedMaterial<StandardMaterial, Ice>;

/// Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes that melt into it.
#[derive(Asset, AsBindGroup, Reflect, Debug, Clone)]
pub struct Ice {
    /// How much the levels of the cells differ: 0 = all are equal.
    /// From 0 to 1.
    #[uniform(100)]
    pub variation: f32,
    /// Number of cells along one unit of texture coordinate.
    /// From 1 to 200.
    #[uniform(100)]
    pub cell_count: f32,
    /// Thickness of a cell of level 1.
    /// From 0 to 10, in m.
    #[uniform(100)]
    pub thickness_factor: f32,
    /// Width of the slope next to an edge, in cells.
    /// From 0.05 to 1.
    #[uniform(100)]
    pub bevel: f32,
    /// The length after which 1/e (37 %) of the light remains; 0 = opaque.
    /// From 0 to 10, in m.
    #[uniform(100)]
    pub attenuation_distance: f32,
    /// Multiplies the texture.
    #[uniform(100)]
    pub tint: Vec4,
    /// 0 = not a metal, 1 = metal.
    /// From 0 to 1.
    #[uniform(100)]
    pub metalness: f32,
    /// 0 = smooth as a mirror, 1 = rough as chalk.
    /// From 0 to 1.
    #[uniform(100)]
    pub surface_roughness: f32,
    /// Height of the thickest cells above their edges.
    /// From 0 to 1, in m.
    #[uniform(100)]
    pub relief: f32,
    /// Change of the texture coordinates per world unit along T and along B.
    #[uniform(100)]
    pub uv_per_unit: Vec2,
    /// Multiplies the texture.
    /// From 0 to 1.
    #[uniform(100)]
    pub cover: f32,
    /// Velocity of the red layer.
    #[uniform(100)]
    pub red_speed: Vec2,
    /// Velocity of the green layer.
    #[uniform(100)]
    pub green_speed: Vec2,
    /// Velocity of the blue layer.
    #[uniform(100)]
    pub blue_speed: Vec2,
    /// Colour of the light in the red and green layers, where both are bright.
    #[uniform(100)]
    pub vein_color: Vec3,
    /// Colour of the light in the blue layer.
    #[uniform(100)]
    pub spark_color: Vec3,
    /// The length, in texture coordinates, over which slopes are measured: about one texel.
    /// From 0.0001 to 0.1.
    #[uniform(100)]
    pub texel_size: f32,
    /// Width of the soft edge, in the texture's values.
    /// From 0.01 to 1.
    #[uniform(100)]
    pub edge: f32,
    /// How much is eroded: 0 = nothing, 1 = everything.
    /// From 0 to 1.
    #[uniform(100)]
    pub erosion: f32,
    /// Height of the step in the surface at the edge.
    /// From 0 to 1, in m.
    #[uniform(100)]
    pub edge_height: f32,
    /// How far the normal bends the light's direction inside the body: 0 ignores the shape.
    /// From 0 to 1.
    #[uniform(100)]
    pub distortion: f32,
    /// Colour of the transmitted light.
    #[uniform(100)]
    pub subsurface_color: Vec3,
    /// Factor on the whole result.
    /// From 0 to 1.
    #[uniform(100)]
    pub attenuation: f32,
    /// Strength of the glow towards the light.
    /// From 0 to 20.
    #[uniform(100)]
    pub scale: f32,
    /// Glow that does not depend on the direction.
    /// From 0 to 1.
    #[uniform(100)]
    pub ambient: f32,
    /// How narrow the glow around the light is: the larger, the smaller the spot.
    /// From 1 to 32.
    #[uniform(100)]
    pub power: f32,
    #[uniform(100)]
    padding_0: f32,
    /// Colour of the surface (an sRGB texture), with its opacity in alpha.
    /// Without an image it is white.
    #[texture(101)]
    #[sampler(102)]
    pub base_color_texture: Option<Handle<Image>>,
    /// Cover on the ice (snow, rock): black = bare ice, white = covered.
    /// Without an image it is white: for none of it, give it an image of one black texel, (0, 0, 0).
    #[texture(103)]
    #[sampler(104)]
    pub cover_texture: Option<Handle<Image>>,
    /// Three pictures in one texture: red, green and blue each hold a layer.
    /// Without an image it is white: for none of it, give it an image of one black texel, (0, 0, 0).
    #[texture(105)]
    #[sampler(106)]
    pub packed_texture: Option<Handle<Image>>,
    /// Mask of the erosion: dark parts disappear first.
    /// Without an image it is white.
    #[texture(107)]
    #[sampler(108)]
    pub erosion_texture: Option<Handle<Image>>,
}

impl Default for Ice {
    fn default() -> Self {
        Self {
            variation: 0.6,
            cell_count: 10.0,
            thickness_factor: 0.3,
            bevel: 0.35,
            attenuation_distance: 0.25,
            tint: Vec4::new(0.75, 0.9, 1.0, 1.0),
            metalness: 0.0,
            surface_roughness: 0.12,
            relief: 0.01,
            uv_per_unit: Vec2::new(1.0, 1.0),
            cover: 1.0,
            red_speed: Vec2::new(0.02, 0.0),
            green_speed: Vec2::new(-0.01, 0.015),
            blue_speed: Vec2::new(0.0, -0.025),
            vein_color: Vec3::new(0.3, 0.8, 1.0),
            spark_color: Vec3::new(0.6, 0.9, 1.0),
            texel_size: 0.002,
            edge: 0.15,
            erosion: 0.2,
            edge_height: 0.02,
            distortion: 0.2,
            subsurface_color: Vec3::new(0.55, 0.85, 1.0),
            attenuation: 0.8,
            scale: 2.0,
            ambient: 0.12,
            power: 6.0,
            padding_0: 0.0,
            base_color_texture: None,
            cover_texture: None,
            packed_texture: None,
            erosion_texture: None,
        }
    }
}

impl Ice {
    /// The material with its defaults.
    pub fn material() -> IceMaterial {
        IceMaterial {
            base: StandardMaterial {
                alpha_mode: AlphaMode::Mask(0.5),
                opaque_render_method: OpaqueRendererMethod::Forward,
                ..default()
            },
            extension: Self::default(),
        }
    }
}

impl MaterialExtension for Ice {
    fn fragment_shader() -> ShaderRef {
        "shaders/ice.wesl".into()
    }
}
