/* What compiled kernels ask of numba's run time: memory for arrays, with a count of who holds it. */
#include <stdint.h>
#include <stdlib.h>

typedef struct {
    size_t holders;
    void (*destroy)(void *data, size_t size, void *info);
    void *info, *data;
    size_t size;
    void *allocator;
} Array;

void *NRT_Allocate(size_t size)
{
    return malloc(size);
}

void NRT_Free(void *data)
{
    free(data);
}

Array *NRT_MemInfo_alloc_aligned(size_t size, unsigned alignment)
{
    size_t head = sizeof(Array) + alignment;
    Array *array = size > SIZE_MAX - head ? NULL : malloc(head + size);
    if (!array) return NULL; /* the kernel gives up: its status is not 0 */
    uintptr_t data = (uintptr_t)(array + 1);
    if (alignment) data = (data + alignment - 1) / alignment * alignment;
    *array = (Array){.holders = 1, .data = (void *)data, .size = size};
    return array;
}

Array *NRT_MemInfo_alloc(size_t size)
{
    return NRT_MemInfo_alloc_aligned(size, 16);
}

void NRT_MemInfo_call_dtor(Array *array)
{
    if (array->destroy) array->destroy(array->data, array->size, array->info);
    free(array);
}

/* Strides of a contiguous array (C order) in another shape; 0 where it is not contiguous. */
int numba_attempt_nocopy_reshape(intptr_t rank, const intptr_t *shape, const intptr_t *strides,
                                 intptr_t new_rank, const intptr_t *new_shape, intptr_t *new_strides,
                                 intptr_t item, int fortran)
{
    intptr_t step = item;
    for (intptr_t i = rank; i-- > 0; step *= shape[i])
        if (shape[i] != 1 && strides[i] != step) return 0;
    step = item;
    for (intptr_t i = new_rank; i-- > 0; step *= new_shape[i]) new_strides[i] = step;
    return !fortran;
}
