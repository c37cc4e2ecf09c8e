using System;

namespace Crumble {

/// <summary>A function of the library said no. Message has the function, the field and the value.</summary>
public sealed class CrumbleException : Exception {
  /// <summary>What it answered.</summary>
  public ResultCode Code { get; }
  /// <summary>The same as the C API writes it: CRUMBLE_E_NULL and so on.</summary>
  public string Name { get; }

  internal CrumbleException(int result, string name, string text) : base(name + ": " + text) {
    Code = (ResultCode)result;
    Name = name;
  }

  /// <summary>Of the call that just failed on this thread.</summary>
  internal static unsafe CrumbleException Last(int result) {
    return new CrumbleException(result, Text.From(Native.crumble_result_name(result)),
                                Text.From(Native.crumble_last_error()));
  }
}

}
