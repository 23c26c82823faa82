# cmake -D program=FILE -D plugins=DIR [-D module=GLOB] -P elementary_functions.cmake
# Reads the ELF files that users run. Of libm's functions they may call only those of which IEEE 754 leaves no bit open, as
# the others return another last bit on another processor (estimator/elementary_functions), and in no instruction may they
# round a product and a sum once, as others round twice.
cmake_minimum_required(VERSION 3.25)

set(exact ceil floor trunc round rint nearbyint lrint llrint lround llround fmod remainder fma fmin fmax frexp ldexp modf
          scalbn ilogb logb copysign nextafter sqrt)
string(REGEX REPLACE "([a-z0-9]+)" "\\1[fl]?" exact "${exact}")
list(JOIN exact "|" exact)

file(GLOB files "${program}" "${plugins}/macadam_*" ${module})
list(LENGTH files count)
if(count LESS 5)
    message(FATAL_ERROR "${program}: ${count} files to read, expected macadam and its libraries")
endif()

function(read_symbols file kind result)
    execute_process(COMMAND nm -D --${kind}-only "${file}" OUTPUT_VARIABLE out COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCHALL " [A-Za-z] [A-Za-z0-9_]+" names "${out}")
    list(TRANSFORM names REPLACE " . " "")
    set(${result} "${names}" PARENT_SCOPE)
endfunction()

execute_process(COMMAND ldd "${program}" OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(NOT libraries MATCHES "libm\\.so\\.6 => ([^ \n]+)")
    message(FATAL_ERROR "${program}: links no libm.so.6")
endif()
read_symbols("${CMAKE_MATCH_1}" defined of_libm)
foreach(expected exp sin atan2 cexp)
    if(NOT expected IN_LIST of_libm)
        message(FATAL_ERROR "libm.so.6 seems to have no ${expected}: its symbols were not read")
    endif()
endforeach()

set(findings "")
foreach(file IN LISTS files)
    read_symbols("${file}" undefined called)
    foreach(name IN LISTS called)
        if(name IN_LIST of_libm AND NOT name MATCHES "^(${exact})$")
            list(APPEND findings
                "${file}: calls libm's ${name}, expected its namesake of musl (functions of estimator/elementary_functions/CMakeLists.txt)")
        endif()
    endforeach()
    execute_process(COMMAND objdump -d --no-show-raw-insn --section=.text "${file}"
        COMMAND grep -m 1 -E "\\b(vfn?m(add|sub)|fn?m(add|sub)\\b)" OUTPUT_VARIABLE fused OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(fused)
        list(APPEND findings "${file}: '${fused}', expected no fused product and sum (-ffp-contract=off)")
    endif()
endforeach()
if(findings)
    list(JOIN findings "\n" words)
    message(FATAL_ERROR "${words}")
endif()
message(STATUS "${count} files compute the same bits on any processor")
