using System;

namespace Crumble {

public unsafe partial struct ArrayView {
  /// <summary>Scalars in all rows.</summary>
  public int Length { get { return checked((int)(Count * Components)); } }
  /// <summary>The rows, packed. Throws InvalidOperationException when they hold another kind of number.</summary>
  public double* Doubles { get { return (double*)Packed(Crumble.ScalarType.Float64, 8); } }
  /// <inheritdoc cref="Doubles"/>
  public float* Floats { get { return (float*)Packed(Crumble.ScalarType.Float32, 4); } }
  /// <inheritdoc cref="Doubles"/>
  public uint* UInts { get { return (uint*)Packed(Crumble.ScalarType.Uint32, 4); } }
  /// <inheritdoc cref="Doubles"/>
  public byte* Bytes { get { return (byte*)Packed(Crumble.ScalarType.Uint8, 1); } }

#if NETSTANDARD2_1_OR_GREATER || NETCOREAPP2_1_OR_GREATER || UNITY_2021_2_OR_NEWER || CRUMBLE_SPAN
  /// <summary>The rows as a span.</summary>
  public ReadOnlySpan<double> DoubleSpan { get { return new ReadOnlySpan<double>(Doubles, Length); } }
  /// <inheritdoc cref="DoubleSpan"/>
  public ReadOnlySpan<float> FloatSpan { get { return new ReadOnlySpan<float>(Floats, Length); } }
  /// <inheritdoc cref="DoubleSpan"/>
  public ReadOnlySpan<uint> UIntSpan { get { return new ReadOnlySpan<uint>(UInts, Length); } }
  /// <inheritdoc cref="DoubleSpan"/>
  public ReadOnlySpan<byte> ByteSpan { get { return new ReadOnlySpan<byte>(Bytes, Length); } }
#endif

  void* Packed(ScalarType wanted, uint bytes) {
    if (ScalarType != wanted) throw new InvalidOperationException("a view of " + ScalarType + ", not of " + wanted);
    if (Count > 1 && Stride != Components * bytes) throw new InvalidOperationException("a view with gaps between rows");
    return (void*)Data;
  }
}

/// <summary>What has arrays: a mesh, a simulation, a reader. Copies go into arrays of the caller and make no
/// garbage.</summary>
public abstract unsafe class ArraySource : NativeObject {
  internal abstract int CopyArray(uint which, void* dst, ulong bytes, ulong* needed);
  internal abstract int ViewArray(uint which, ArrayView* view);

  /// <summary>A look into the object's own memory, without a copy. How long it is valid docs/capi.md says: of a
  /// simulation until the next call that changes it, of a reader until its next Update, of a mesh as long as it is.</summary>
  public ArrayView GetView(ArrayId which) {
    ArrayView view;
    Check(ViewArray((uint)which, &view));
    return view;
  }

  /// <summary>Scalars in all rows of an array: the length that Copy needs.</summary>
  public int GetLength(ArrayId which) {
    ulong bytes;
    Check(CopyArray((uint)which, null, 0, &bytes));
    return (int)(bytes / SizeOf(Native.ScalarOf(which)));
  }

  /// <summary>Copies the rows of an array, packed, to the beginning of `dst`. Returns how many scalars these are.
  /// CRUMBLE_E_BUFFER_TOO_SMALL when `dst` is too short.</summary>
  public int Copy(ArrayId which, double[] dst) {
    Expect(which, ScalarType.Float64);
    fixed (double* to = dst) return Copy(which, to, dst, 8);
  }
  /// <inheritdoc cref="Copy(ArrayId, double[])"/>
  public int Copy(ArrayId which, float[] dst) {
    Expect(which, ScalarType.Float32);
    fixed (float* to = dst) return Copy(which, to, dst, 4);
  }
  /// <inheritdoc cref="Copy(ArrayId, double[])"/>
  public int Copy(ArrayId which, uint[] dst) {
    Expect(which, ScalarType.Uint32);
    fixed (uint* to = dst) return Copy(which, to, dst, 4);
  }
  /// <inheritdoc cref="Copy(ArrayId, double[])"/>
  public int Copy(ArrayId which, byte[] dst) {
    Expect(which, ScalarType.Uint8);
    fixed (byte* to = dst) return Copy(which, to, dst, 1);
  }

  /// <summary>The rows of an array in a new one.</summary>
  public double[] GetDoubles(ArrayId which) { var all = new double[GetLength(which)]; Copy(which, all); return all; }
  /// <inheritdoc cref="GetDoubles"/>
  public float[] GetFloats(ArrayId which) { var all = new float[GetLength(which)]; Copy(which, all); return all; }
  /// <inheritdoc cref="GetDoubles"/>
  public uint[] GetUInts(ArrayId which) { var all = new uint[GetLength(which)]; Copy(which, all); return all; }
  /// <inheritdoc cref="GetDoubles"/>
  public byte[] GetBytes(ArrayId which) { var all = new byte[GetLength(which)]; Copy(which, all); return all; }

  // C# has no address for an array without elements; the library has rows to write or none.
  int Copy(ArrayId which, void* to, Array dst, uint bytes) {
    if (dst == null) throw new ArgumentNullException("dst");
    ulong needed, nothing;
    Check(CopyArray((uint)which, to == null ? &nothing : to, (ulong)dst.Length * bytes, &needed));
    return (int)(needed / bytes);
  }

  // The library copies bytes and does not know what they are taken for. Numbers that it does not know it refuses itself.
  static void Expect(ArrayId which, ScalarType wanted) {
    ScalarType held = Native.ScalarOf(which);
    if (held != 0 && held != wanted) throw new ArgumentException("array " + which + " holds " + held + ", not " + wanted);
  }

  static ulong SizeOf(ScalarType type) {
    return type == ScalarType.Float64 ? 8u : type == ScalarType.Uint8 ? 1u : 4u;
  }
}

}
