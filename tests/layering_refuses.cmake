cmake_minimum_required(VERSION 3.25)

# The layering test itself can fail: a house with one wrong arrow or one open window is refused.
# cmake -D root=. -D scratch=DIR -P tests/layering_refuses.cmake

function(expect_refusal folder line words)
    file(REMOVE_RECURSE ${scratch})
    file(COPY ${root}/estimator ${root}/mapping ${root}/storage ${root}/render ${root}/app DESTINATION ${scratch})
    file(WRITE ${scratch}/${folder}/deep/inside/new.cpp "${line}\n")
    execute_process(COMMAND ${CMAKE_COMMAND} -D root=${scratch} -P ${root}/tests/layering.cmake
                    RESULT_VARIABLE status ERROR_VARIABLE said)
    file(REMOVE_RECURSE ${scratch})
    string(REGEX REPLACE "[ \n]+" " " said "${said}") # CMake breaks its messages into lines
    if(status EQUAL 0 OR NOT said MATCHES "${words}")
        message(SEND_ERROR "'${line}' in ${folder} was not refused: ${said}")
    endif()
endfunction()

expect_refusal(estimator "#include \"mapping/segment.hpp\"" "estimator may not use mapping")
expect_refusal(storage "#include \"render/map.hpp\"" "storage may not use render")
expect_refusal(mapping "#include <fstream>" "mapping computes only")
expect_refusal(estimator "#include <iostream>" "estimator computes only")
expect_refusal(render "#include <nlohmann/json.hpp>" "more than one file includes json")
expect_refusal(storage "auto map = GDALDataset::Open(name);" "only storage/late/gdal_door.cpp opens files by GDAL")
