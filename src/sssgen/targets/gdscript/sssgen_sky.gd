## The light of the surroundings, as a matrix: from a direction, with w = 1, to what a white matte surface shows that faces
## it. It is linear in the direction, so that it has no more than one bright side for each channel. What is quadratic in the
## direction is beside it.
class SkyLight:
	## Of the picture that is measured.
	const SIZE := Vector2i(32, 16)
	## Godot makes the light of a sky in some frames.
	const FRAMES := 4
	## Those of an environment that decide.
	const PROPERTIES: Array[String] = [
		"ambient_light_source", "ambient_light_color", "ambient_light_energy", "ambient_light_sky_contribution",
		"background_mode", "background_color", "background_energy_multiplier", "sky",
	]
	var matrix := Projection(Vector4.ZERO, Vector4.ZERO, Vector4.ZERO, Vector4.ZERO)
	## For each spherical harmonic of order 2 what it adds to this.
	var bends := PackedVector4Array()
	var _environment: Environment
	var _facts := []
	var _left := 0

	## What a camera shows, or null.
	static func environment_of(eye: Camera3D) -> Environment:
		if eye.environment != null:
			return eye.environment
		var world := eye.get_world_3d()
		return world.environment if world.environment != null else world.fallback_environment

	func follow(eye: Camera3D) -> void:
		_environment = environment_of(eye)
		var facts := [_environment]
		if _environment != null:  # it does not tell of its changes
			facts.append_array(PROPERTIES.map(func(property): return _environment.get(property)))
		if facts != _facts:
			_facts = facts
			_left = FRAMES
		if _left > 0:
			_left -= 1
			bends.fill(Vector4.ZERO)
			matrix = _measured()

	func _init() -> void:
		bends.resize(5)

	func is_dark() -> bool:
		return matrix == Projection(Vector4.ZERO, Vector4.ZERO, Vector4.ZERO, Vector4.ZERO)

	## What a white matt surface shows that faces a direction.
	func light(way: Vector3) -> Vector4:
		var result := matrix * Vector4(way.x, way.y, way.z, 1.0)
		var values := harmonics(way)
		for i in 5:
			result += values[4 + i] * bends[i]
		return result

	## The real spherical harmonics up to order 2 in a unit direction.
	static func harmonics(way: Vector3) -> PackedFloat32Array:
		return [
			0.28209479, 0.48860251 * way.y, 0.48860251 * way.z, 0.48860251 * way.x,
			1.09254843 * way.x * way.y, 1.09254843 * way.y * way.z, 0.31539157 * (3.0 * way.z * way.z - 1.0),
			1.09254843 * way.x * way.z, 0.54627422 * (way.x * way.x - way.y * way.y),
		]

	func _measured() -> Projection:
		var result := Projection(Vector4.ZERO, Vector4.ZERO, Vector4.ZERO, Vector4.ZERO)
		if _environment == null:
			return result
		var of_background := _environment.ambient_light_source == Environment.AMBIENT_SOURCE_BG
		var background := _environment.background_mode if of_background else Environment.BG_KEEP
		var color := Color.BLACK
		if background == Environment.BG_CLEAR_COLOR:
			color = RenderingServer.get_default_clear_color().srgb_to_linear()
		elif background == Environment.BG_COLOR:
			color = _environment.background_color.srgb_to_linear() * _environment.background_energy_multiplier
		elif not of_background and _environment.ambient_light_source != Environment.AMBIENT_SOURCE_DISABLED:
			color = _environment.ambient_light_color.srgb_to_linear() * _environment.ambient_light_energy
		var of_sky := background == Environment.BG_SKY or _environment.ambient_light_source == Environment.AMBIENT_SOURCE_SKY
		var share := _environment.ambient_light_sky_contribution if of_sky else 0.0
		if share > 0.0 and _environment.sky != null:
			result = _of_sky()
		for i in 4:
			result[i] *= share
		for i in 5:
			bends[i] *= share
		result.w += Vector4(color.r, color.g, color.b, 0.0) * (1.0 - share)
		return result

	func _of_sky() -> Projection:
		var energy := _environment.background_energy_multiplier
		var picture := RenderingServer.sky_bake_panorama(_environment.sky.get_rid(), energy, true, SIZE)
		var result := Projection(Vector4.ZERO, Vector4.ZERO, Vector4.ZERO, Vector4.ZERO)
		var whole := 0.0
		for y in SIZE.y if picture != null and not picture.is_empty() else 0:
			var polar := PI * y / SIZE.y  # of the texel's first corner, as Godot draws them
			for x in SIZE.x:
				var around := TAU * x / SIZE.x
				var way := Vector3(sin(around) * sin(polar), cos(polar), cos(around) * sin(polar))
				var color := picture.get_pixel(x, y)
				var light := Vector4(color.r, color.g, color.b, 0.0) * sin(polar)
				whole += sin(polar)
				for axis in 3:
					result[axis] += 3.0 * way[axis] * light
				result.w += light
				var values := harmonics(way)
				for i in 5:
					bends[i] += 2.0 * TAU * values[4 + i] * light
		for i in 4:
			result[i] /= maxf(whole, 1e-6)
		for i in 5:
			bends[i] /= maxf(whole, 1e-6)
		return result
