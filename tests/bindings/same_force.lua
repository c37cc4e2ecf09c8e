-- examples/c/same_force.c through LuaJIT's FFI.
local ffi = require("ffi")
local file = assert(io.open(os.getenv("CDEF")))
ffi.cdef(file:read("*a"))
file:close()
local crumble = ffi.load(os.getenv("CRUMBLE_LIBRARY"))

local function check(result)
  if result ~= 0 then error(ffi.string(crumble.crumble_last_error())) end
end

local mesh, sim = ffi.new("crumble_mesh[1]"), ffi.new("crumble_sim[1]")
check(crumble.crumble_mesh_create_paper(crumble.CRUMBLE_PAPER_CUBE, mesh))
check(crumble.crumble_sim_create(mesh[0], nil, sim))
check(crumble.crumble_sim_fix_below(sim[0], 1e-6))
local stick = ffi.new("crumble_tool_def[1]")
check(crumble.crumble_tool_def_init(stick, ffi.sizeof("crumble_tool_def")))
check(crumble.crumble_sim_add_tool(sim[0], stick, nil))

local pose, wrench = ffi.new("crumble_pose[1]"), ffi.new("crumble_wrench[1]")
pose[0].orientation[0] = 1
for step = 1, 1500 do
  pose[0].position[1] = 0.034 - 1e-5 * step
  check(crumble.crumble_sim_step(sim[0], pose, wrench))
end
local counters, hash = ffi.new("crumble_counters[1]"), ffi.new("uint64_t[1]")
counters[0].struct_size = ffi.sizeof("crumble_counters")
check(crumble.crumble_sim_get_counters(sim[0], counters))
check(crumble.crumble_sim_state_hash(sim[0], hash))
print(string.format("force %.12f N\ncuts %d\nhash %s", wrench[0].force[1], tonumber(counters[0].cuts),
  bit.tohex(hash[0], 16)))
check(crumble.crumble_sim_destroy(sim[0]))
check(crumble.crumble_mesh_destroy(mesh[0]))
