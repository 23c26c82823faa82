# cmake -D build=BUILD -D folder=DIR -P installed.cmake
# Installs into DIR/first, moves the tree to DIR/moved, and maps a recorded trip with what is there:
# the program finds its libraries wherever the tree stands, and nothing of the build folder is in it.
file(REMOVE_RECURSE "${folder}")
file(MAKE_DIRECTORY "${folder}/maps")

function(run_checked)
    execute_process(COMMAND ${ARGV} OUTPUT_VARIABLE out ERROR_VARIABLE error RESULT_VARIABLE status)
    if(NOT status EQUAL 0)
        list(JOIN ARGV " " words)
        message(FATAL_ERROR "${words}: ${status}\n${out}${error}")
    endif()
endfunction()

run_checked("${CMAKE_COMMAND}" --install "${build}" --prefix "${folder}/first" --strip)
file(RENAME "${folder}/first" "${folder}/moved")
set(program "${folder}/moved/bin/macadam")
set(trip "${folder}/moved/share/doc/macadam/examples/comma2k19/comma2k19_rav4.trip.csv")
run_checked("${program}" init "${folder}/maps/roads.gpkg" --trace "${trip}")
run_checked("${program}" import "${folder}/maps/roads.gpkg" "${trip}")
run_checked("${program}" render "${folder}/maps/roads.gpkg" -o "${folder}/maps/map.png" --size 512x512)
run_checked("${program}" export "${folder}/maps/roads.gpkg" -o "${folder}/maps/roads.fgb")
foreach(made maps/map.png maps/roads.fgb moved/share/man/man1/macadam-import.1.gz
        moved/share/doc/macadam/copyright moved/share/doc/macadam/LICENSE)
    if(NOT EXISTS "${folder}/${made}")
        message(FATAL_ERROR "${folder}/${made}: is missing")
    endif()
endforeach()

# So are the words of every language.
run_checked("${program}" report "${folder}/maps/roads.gpkg" -o "${folder}/maps/report.html" --language hu)

# The page of a site is found wherever the tree stands, if the build has it.
if(EXISTS "${folder}/moved/share/macadam/site")
    run_checked("${program}" export "${folder}/maps/roads.gpkg" -o "${folder}/maps/site" --format site)
    if(NOT EXISTS "${folder}/maps/site/assets/maplibre-gl.mjs" OR NOT EXISTS "${folder}/maps/site/roads.pmtiles")
        message(FATAL_ERROR "${folder}/maps/site: has no page or no tiles")
    endif()
endif()

# The Python module opens the plug-ins of the same tree (the network is read by GDAL's).
file(GLOB module "${folder}/moved/lib/python3/dist-packages/macadam/_macadam.*.so")
if(module)
    run_checked("${CMAKE_COMMAND}" -E env "PYTHONPATH=${folder}/moved/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1
                /usr/bin/python3 -c "import macadam, sys; assert macadam.match(*sys.argv[1:]).rows > 0"
                "${trip}" "${folder}/maps/roads.fgb")
endif()

file(GLOB elf_files "${program}" ${module} "${folder}/moved/lib/macadam/plugins/*")
foreach(file IN LISTS elf_files)
    file(STRINGS "${file}" traces REGEX "${build}/")
    if(traces)
        message(FATAL_ERROR "${file}: names the build folder: ${traces}")
    endif()
endforeach()
