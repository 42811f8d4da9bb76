#!/bin/sh
# Builds the fuzz target into the folder given. Needs clang with libFuzzer.
#   sh engine/fuzz/build.sh build/fuzz && build/fuzz/engines -max_total_time=600
set -eu
cd "$(dirname "$0")/../.."
to=${1:?give a folder}
mkdir -p "$to"
checks="-g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined"
strict="-std=c++17 -ffp-contract=off -Icore/include -DHYST_X86 $checks"
kernels() {
    for part in exact sum; do
        clang++ $strict -Wno-psabi -DHYST_INSTRUCTION_SET="$@" -c engine/simd/${part}_kernels.cpp \
            -o "$to/${part}_$1.o"
    done
}
kernels baseline
kernels avx2 -mavx2 -mfma
kernels avx512 -mavx512f -mavx512dq -mavx512vl -mfma
while read -r source; do
    clang -std=c99 -ffp-contract=off -Icore/include $checks -c "core/$source" \
        -o "$to/core_$(basename "$source" .c).o"
done < core/SOURCES
for source in engine/simd/kernels.cpp engine/*.cpp engine/kinds/*.cpp engine/kinds/fast/*.cpp \
    engine/dual/derivative.cpp; do
    case $source in *module.cpp | *_binding.cpp | *stepper.cpp | */single.cpp) continue ;; esac
    clang++ $strict -c "$source" -o "$to/$(echo "$source" | tr / _).o"
done
# The kernel's own derivative, as engine/dual/CMakeLists.txt has it.
sed -n 's/^const hyst_kind \(hyst_[a-z_]*\) = .*/\&\1,/p' core/src/*.c | tr '\n' ' ' > "$to/all_kinds"
grep -l '^const hyst_kind hyst_' core/src/*.c | sed 's|core/src/\(.*\)|#include "\1"|' \
    > "$to/core_kinds.inc"
echo "#define HYST_ALL_KINDS $(cat "$to/all_kinds")" >> "$to/core_kinds.inc"
ls engine/kinds/*.cpp | sed 's|engine/\(.*\)|#include "\1"|' > "$to/kinds.inc"
tangents() {
    source=$1 count=$2 name=tangents_$3
    shift 3
    clang++ $strict -Wno-psabi -Icore/src -Iengine -I"$to" -DHYST_TANGENTS="$count" \
        -DHYST_KINDS="$name" "$@" -c "engine/dual/$source.cpp" -o "$to/$name.o"
}
for count in 4 8 16; do
    tangents stages $count $count
    tangents pass $count ${count}_avx2 -mavx2 -mfma
    tangents pass $count ${count}_avx512 -mavx512f -mavx512dq -mavx512vl -mfma
done
clang++ $strict -fsanitize=fuzzer engine/fuzz/engines.cpp "$to"/*.o -lpthread -o "$to/engines"
