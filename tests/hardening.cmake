# cmake -D program=FILE -D plugins=DIR -D rpath=PATH -D commands=compile_commands.json -D cet=ON|OFF
#       -P hardening.cmake
# Reads the ELF files that users run, the program and the libraries that it opens: each must be built
# so that an error in it is hard to use, and look for libraries in no folder but the system's and PATH.

file(GLOB files "${program}" "${plugins}/macadam_*.so")
list(LENGTH files count)
if(count LESS 5)
    message(FATAL_ERROR "${program}: ${count} files to read, expected macadam and its libraries")
endif()

function(read_elf file option result)
    execute_process(COMMAND readelf -W ${option} "${file}" OUTPUT_VARIABLE out COMMAND_ERROR_IS_FATAL ANY)
    set(${result} "${out}" PARENT_SCOPE)
endfunction()

set(findings "")
macro(expect_match text pattern words)
    if(NOT "${${text}}" MATCHES "${pattern}")
        list(APPEND findings "${file}: ${words}")
    endif()
endmacro()

foreach(file IN LISTS files)
    read_elf("${file}" -h header)
    read_elf("${file}" -l segments)
    read_elf("${file}" -d dynamic)
    read_elf("${file}" --dyn-syms symbols)
    expect_match(header "Type: +DYN" "is not position independent")
    expect_match(segments "GNU_RELRO" "has no read-only relocations")
    expect_match(segments "GNU_STACK[^\n]* RW +0x" "has a stack that can be executed")
    expect_match(dynamic "BIND_NOW|FLAGS_1[^\n]*NOW" "binds functions late")
    expect_match(symbols "__stack_chk_fail" "has no stack protector")
    if(dynamic MATCHES "(RPATH|RUNPATH)[^\n]*\\[([^]]*)\\]" AND NOT CMAKE_MATCH_2 STREQUAL "${rpath}")
        list(APPEND findings "${file}: looks for libraries in '${CMAKE_MATCH_2}', expected '${rpath}'")
    endif()
    if(DEFINED cet AND cet)
        execute_process(COMMAND objdump -d --no-show-raw-insn --section=.text "${file}"
            COMMAND grep -c -m 1 endbr64 OUTPUT_VARIABLE marked OUTPUT_STRIP_TRAILING_WHITESPACE)
        expect_match(marked "^1$" "does not mark the targets of indirect jumps")
    endif()
endforeach()
# Checks of lengths leave no trace in a file where the compiler knows that they hold.
file(STRINGS "${commands}" unchecked REGEX "^ *\"command\"")
list(FILTER unchecked EXCLUDE REGEX "-D_FORTIFY_SOURCE=2")
list(LENGTH unchecked unchecked_count)
if(unchecked_count GREATER 0)
    list(APPEND findings "${commands}: ${unchecked_count} files are compiled without FORTIFY_SOURCE")
endif()
if(findings)
    list(JOIN findings "\n" words)
    message(FATAL_ERROR "${words}")
endif()
message(STATUS "${count} files are hardened")
