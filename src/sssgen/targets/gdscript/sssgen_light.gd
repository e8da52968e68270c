## What one view shows alone. Its number is in the bits above those of layers, and its depths are those of places that are
## nearer than twice the near plane, where nothing else is.
const ALONE := "shader_type spatial;
render_mode %s, specular_disabled, fog_disabled;
uniform uint number;

void vertex() {
    POSITION = %s;
    if (CAMERA_VISIBLE_LAYERS >> 20u != number) {
        POSITION = vec4(2.0, 2.0, 2.0, 1.0);
    }
}

void fragment() {
    ALBEDO = vec3(%s);
    ROUGHNESS = 0.5;
}
"
const NEARER := "PROJECTION_MATRIX * MODELVIEW_MATRIX * vec4(VERTEX, 1.0);
    POSITION.z = mix(POSITION.z, POSITION.w, 0.75)"


## The light that a white matt body reflects in place of a body, in the lights, shadows and surroundings of its world. The
## camera sees what the eye does, as bodies that a camera does not see cast no shadow for it. Black is in front of them, so
## that they are not shaded.
class LightLayer extends View:
	## Effects to switch off: they are no reflection of the body, or the eye's own picture gets them later.
	const PLAIN := {
		"glow_enabled": false, "adjustment_enabled": false, "volumetric_fog_enabled": false, "ssao_enabled": false,
		"ssil_enabled": false, "ssr_enabled": false, "tonemap_mode": Environment.TONE_MAPPER_LINEAR, "tonemap_exposure": 1.0,
	}
	## Settings to copy from the eye's viewport: shadows of lamps, and details of meshes.
	const SHARED: Array[String] = [
		"positional_shadow_atlas_size", "positional_shadow_atlas_16_bits", "positional_shadow_atlas_quad_0",
		"positional_shadow_atlas_quad_1", "positional_shadow_atlas_quad_2", "positional_shadow_atlas_quad_3", "mesh_lod_threshold",
	]
	static var last := 0
	var number: int
	var copy := Copy.new()
	var cover := Copy.new()
	var quad := QuadMesh.new()
	var looks := {}

	func _init(above: Node) -> void:
		super(above, 0.0)
		last = last % 4095 + 1
		number = last
		for one: Copy in [copy, cover]:
			one.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
			one.gi_mode = GeometryInstance3D.GI_MODE_DISABLED
			add_child(one)
		for culls in [true, false]:
			looks[culls] = _look(["diffuse_burley, cull_%s" % ("back" if culls else "disabled"), NEARER, "1.0"])
		quad.size = Vector2(2.0, 2.0)
		cover.set_base(quad.get_rid())
		cover.custom_aabb = AABB(-FAR * Vector3.ONE, 2.0 * FAR * Vector3.ONE)
		cover.material_override = _look(["unshaded, cull_disabled", "vec4(VERTEX.xy, 0.5, 1.0)", "0.0"])
		cover.layers = number << 20

	func _look(parts: Array) -> ShaderMaterial:
		var material := material_of(ALONE % parts)
		material.set_shader_parameter("number", number)
		return material

	func aim_as(eye: Camera3D, ball: Ball) -> void:
		super(eye, ball)
		camera.cull_mask = eye.cull_mask | (number << 20)
		camera.environment = SkyLight.environment_of(eye)
		if camera.environment != null:
			camera.environment = camera.environment.duplicate()
			for property: String in PLAIN:
				camera.environment.set(property, PLAIN[property])
		# the eye exposes the picture; Mobile has twice the light of a sky where a camera has attributes
		var exposed := eye.attributes if eye.attributes != null else eye.get_world_3d().camera_attributes
		camera.attributes = CameraAttributesPractical.new() if exposed != null else null
		for property in SHARED:
			set(property, eye.get_viewport().get(property))

	func take(body: GeometryInstance3D, _ball: Vector4, _margin: float) -> void:
		copy.follow(body)
		copy.take_bounds(body)
		copy.layers = body.layers
		copy.material_override = looks[Copy.materials_of(body).all(Casters.culls_back)]
