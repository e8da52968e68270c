## The light inside a body, of all lights and of the surroundings: a volume that is summed when one of them has changed, by a
## thread beside the frames.
class InnerLight extends Pass:
	## Directions that are spread evenly over the sphere (Fibonacci).
	const WAYS := 128
	const NO_TASK := -1
	var response: Response
	var volume := ImageTexture3D.new()
	## The task of the thread. While it runs, `_parts` and `_slices` are its own.
	var _task := NO_TASK
	var _slices: Array[Image] = []
	## What changes the light of a source → that light, for a colour of 1.
	var _parts := {}
	## The parts of the volume with their colours.
	var _shown := []
	## The sky and the body's turn that `_sky_light` is of.
	var _sky_facts := []
	var _sky_light := _dark()

	func _init(of_pass: Dictionary, file: String) -> void:
		data = of_pass
		response = Response.load_from(file)
		if response == null:
			return
		var black := PackedVector4Array()
		black.resize(response.count)
		volume.create(Image.FORMAT_RGBAH, response.size.x, response.size.y, response.size.z, false, response.slices(black))
		drawn[volume] = true

	func texture() -> Texture:
		return volume if response != null else null

	func take(material: ShaderMaterial) -> void:
		if response == null:
			return
		super(material)
		if material not in users:
			return
		for uniform in material.shader.get_shader_uniform_list():
			if uniform["name"] in response.parameters:
				material.set_shader_parameter(uniform["name"], _value(response.parameters[uniform["name"]]))

	static func _value(value: Variant) -> Variant:
		if not value is Array:
			return value
		var columns: Array[Vector4] = []
		if value.size() == 3:
			return Vector3(value[0], value[1], value[2])
		for i in range(0, 16, 4):
			columns.append(Vector4(value[i], value[i + 1], value[i + 2], value[i + 3]))
		return Projection(columns[0], columns[1], columns[2], columns[3])

	func draw(body: GeometryInstance3D, _eye: Camera3D, scene: Node) -> void:
		if users.is_empty():
			return
		# the first light is shown at once, and each one in pictures of a film
		var waits: bool = scene.inner_light_waits or _slices.is_empty() or OS.has_feature("movie")
		if _task != NO_TASK:
			if not waits and not WorkerThreadPool.is_task_completed(_task):
				return
			_show()
		var place := body.get_global_transform_interpolated()
		var inverse := place.affine_inverse()
		# what changes the light of a source → the function that computes it
		var sources := {}
		var shown := []
		for light: Light3D in scene.lights_on_body():
			var facts := Casters.vectors_of(light)
			var at := Vector3(facts[0].x, facts[0].y, facts[0].z)
			var afar := facts[0].w == 0.0
			var key := [(inverse.basis * at).normalized()] if afar else [facts, place]
			if afar:
				sources[key] = response.from_afar.bind(key[0])
			else:
				sources[key] = func(): return response.from_near(inverse * at, _strengths(facts, place))
			var color := light.light_color.srgb_to_linear() * light.light_energy * (-1.0 if light.light_negative else 1.0)
			shown.append([key, Vector4(color.r, color.g, color.b, 0.0)])
		var around := _around(scene.sky(), place.basis)
		if around != _dark():
			sources[around] = response.from_around.bind(around)
			shown.append([around, Vector4.ONE])
		if shown == _shown:
			return
		_shown = shown
		_task = WorkerThreadPool.add_task(_compute.bind(sources, shown))
		if waits:
			_show()

	## In the thread: the light of sources that are new, and the volume.
	func _compute(sources: Dictionary, shown: Array) -> void:
		var parts := {}
		for key: Variant in sources:
			parts[key] = _parts[key] if key in _parts else sources[key].call()
		_parts = parts
		_slices = response.slices(_sum(shown))

	## Shows what the thread has computed.
	func _show() -> void:
		WorkerThreadPool.wait_for_task_completion(_task)
		_task = NO_TASK
		volume.update(_slices)

	func _sum(shown: Array) -> PackedVector4Array:
		var sum := PackedVector4Array()
		sum.resize(response.count)
		for source: Array in shown:
			var part: PackedVector4Array = _parts[source[0]]
			var color: Vector4 = source[1]
			for voxel in response.count:
				sum[voxel] += color * part[voxel]
		return sum

	## The share of a light that its distance and its cone leave in each voxel, as Godot has it.
	func _strengths(facts: PackedVector4Array, place: Transform3D) -> PackedFloat32Array:
		var from := Vector3(facts[0].x, facts[0].y, facts[0].z)
		var axis := Vector3(facts[1].x, facts[1].y, facts[1].z)
		var strengths := PackedFloat32Array()
		strengths.resize(response.count)
		for voxel in response.count:
			var way := place * response.places[voxel] - from
			var away := maxf(way.length(), 1e-3)
			var edge := maxf(1.0 - (away * facts[2].x) ** 4.0, 0.0)
			var rim := (1.0 - maxf(way.dot(axis) / away, facts[1].w)) / (1.0 - facts[1].w)
			strengths[voxel] = edge * edge * away ** -facts[2].y * (1.0 - maxf(rim, 1e-4) ** facts[2].z)
		return strengths

	static func _dark() -> PackedVector4Array:
		var dark := PackedVector4Array()
		dark.resize(9)
		return dark

	## The integrals of a sky, which are computed again when it has changed or the body has turned.
	func _around(sky: SkyLight, turn: Basis) -> PackedVector4Array:
		var facts := [sky.matrix, sky.bends.duplicate(), turn]
		if facts != _sky_facts:
			_sky_facts = facts
			_sky_light = _integrals(sky, turn)
		return _sky_light

	## For each harmonic the integral of the light in object space, from what white matt surfaces show: the cosine leaves π,
	## 2/3 π and π/4 of the orders (Ramamoorthi and Hanrahan 2001).
	func _integrals(sky: SkyLight, turn: Basis) -> PackedVector4Array:
		var sums := _dark()
		if sky.is_dark():
			return sums
		for i in WAYS:
			var y := 1.0 - (2.0 * i + 1.0) / WAYS
			var around := i * PI * (3.0 - sqrt(5.0))
			var way := Vector3(sqrt(1.0 - y * y) * cos(around), y, sqrt(1.0 - y * y) * sin(around))
			var color := sky.light((turn * way).normalized())
			var values := SkyLight.harmonics(way)
			for harmonic in 9:
				sums[harmonic] += values[harmonic] * color
		for harmonic in 9:
			sums[harmonic] *= 4.0 * (1.0 if harmonic == 0 else 1.5 if harmonic < 4 else 4.0) / WAYS
		return sums

	func release() -> void:
		if _task != NO_TASK:
			_show()
		drawn.erase(volume)
		super()
