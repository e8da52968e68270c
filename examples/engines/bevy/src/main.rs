//! A ball of wax with a light behind it. src/wax.rs and assets/shaders/wax.wesl are what
//! `sssgen emit wax.toml --target bevy` writes.

use bevy::prelude::*;

mod wax;
use wax::{Wax, WaxMaterial};

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, MaterialPlugin::<WaxMaterial>::default()))
        .add_systems(Startup, setup)
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<WaxMaterial>>,
) {
    commands.spawn((
        Mesh3d(meshes.add(Sphere::new(0.5))),
        MeshMaterial3d(materials.add(Wax::material())),
    ));
    commands.spawn((
        DirectionalLight::default(),
        Transform::from_xyz(1.0, 1.0, -2.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.spawn((
        Camera3d::default(),
        Transform::from_xyz(0.0, 0.3, 2.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}
