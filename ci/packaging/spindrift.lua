-- Module file (Lmod) of an installed Spindrift: set the prefix, put it on MODULEPATH as spindrift/0.1.0.lua. Its paths are those that the test of the
-- installation finds; Lmod itself was not at hand.
local prefix = "/opt/spindrift/0.1.0"
whatis("Coupled simulation of floating offshore wind turbines")
prepend_path("PATH", pathJoin(prefix, "bin"))
prepend_path("MANPATH", pathJoin(prefix, "share/man"))
prepend_path("PYTHONPATH", pathJoin(prefix, "lib/python3/dist-packages"))
